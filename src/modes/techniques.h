// The techniques, in the order of help and charts. NAME_mode() in each technique's folder returns its row of the table.
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
