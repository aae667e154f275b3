#include "scene/spared_files.h"

#include "scene/scene.h"

namespace tyndall {
void spare_files(const Scene& scene, const OutputPaths& places) {
    for (const InputFile& input : scene.inputs) places.spare(input.path);
    for (const MediumSource& medium : scene.media)
        for (const FileSequence* sequence : volume_sequences(medium)) places.spare_all(all_files(*sequence));
    for (const LightSource& light : scene.lights)
        if (light.gobo) places.spare_all(all_files(light.gobo->sequence));
}
}
