#include "scene/input_files.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
std::vector<const FileSequence*> volume_sequences(const MediumSource& medium) {
    std::vector<const FileSequence*> sequences;
    if (medium.kind != MediumKind::vdb) return sequences;
    sequences.push_back(&medium.sequence);
    const auto add = [&](const GridSource& grid) {
        const auto same = [&](const FileSequence* one) { return one->pattern == grid.sequence.pattern; };
        if (std::ranges::none_of(sequences, same)) sequences.push_back(&grid.sequence);
    };
    for (const auto* grid : {&medium.albedo_grid, &medium.emission_grid, &medium.temperature, &medium.flame})
        if (*grid) add(**grid);
    if (medium.velocity) add(medium.velocity->grid);
    return sequences;
}

std::filesystem::path gobo_file(const GoboSource& gobo, int frame, MissingFrame missing) {
    return *sequence_file(gobo.sequence, frame, missing == MissingFrame::skip ? MissingFrame::hold : missing);
}

std::pair<int, int> frames_shown(const MediumSource& medium, int frame, const Shutter& shutter) {
    if (!shutter) return {frame, frame};
    const auto whole = [&](double frames) { return frame + static_cast<int>(frames); };
    if (medium.blends) return {whole(std::floor(shutter.open)), whole(std::ceil(shutter.close))};
    if (medium.velocity) return {whole(std::floor(shutter.open + 0.5)), whole(std::ceil(shutter.close - 0.5))};
    return {frame, frame};
}

std::vector<FrameFile> frame_files(const Scene& scene, int frame, MissingFrame missing, const Shutter& shutter) {
    std::vector<FrameFile> files;
    for (const MediumSource& medium : scene.media) {
        const auto [first, last] = frames_shown(medium, frame, shutter);
        for (const FileSequence* sequence : volume_sequences(medium))
            for (int shown = first; shown <= last; ++shown)
                files.push_back({true, sequence_file(*sequence, shown, missing)});
    }
    for (const LightSource& light : scene.lights)
        if (light.gobo && !light.gobo->still) files.push_back({false, gobo_file(*light.gobo, frame, missing)});
    return files;
}

void spare_files(const Scene& scene, const OutputPaths& places) {
    for (const InputFile& input : scene.inputs) places.spare(input.path);
    for (const MediumSource& medium : scene.media)
        for (const FileSequence* sequence : volume_sequences(medium)) places.spare_all(all_files(*sequence));
    for (const LightSource& light : scene.lights)
        if (light.gobo) places.spare_all(all_files(light.gobo->sequence));
}
}
