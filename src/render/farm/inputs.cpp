#include "render/farm/inputs.h"

#include "scene/scene.h"

#include <set>

namespace tyndall {
std::vector<std::filesystem::path> input_files(const Scene& scene, const std::vector<int>& frames,
                                               MissingFrame missing) {
    std::set<std::filesystem::path> files;
    const auto add = [&](const std::filesystem::path& file) {
        files.insert(std::filesystem::absolute(file).lexically_normal());
    };
    for (const InputFile& input : scene.inputs) add(input.path);
    for (const MediumSource& medium : scene.media)
        for (const VdbSequence* sequence : volume_sequences(medium))
            for (const int frame : frames)
                if (const auto file = sequence_file(*sequence, frame, missing)) add(*file);
    return {files.begin(), files.end()};
}
}
