// The techniques, in the order of help and charts: one line each. Each makes its row in its folder.
#pragma once
#define TYNDALL_TECHNIQUES(ROW)                                                                                        \
    ROW(march)                                                                                                         \
    ROW(froxel)                                                                                                        \
    ROW(shadow_map)                                                                                                    \
    ROW(shadow_volume)                                                                                                 \
    ROW(cone)                                                                                                          \
    ROW(billboard)                                                                                                     \
    ROW(radial_blur)                                                                                                   \
    ROW(path)
