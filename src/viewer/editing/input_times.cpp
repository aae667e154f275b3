#include "viewer/editing/input_times.h"
#include "scene/input_files.h"
#include "scene/scene.h"

namespace tyndall {
namespace {
std::optional<InputTime> time_of(const std::filesystem::path& file) {
    std::error_code error;
    InputTime time{file, std::filesystem::last_write_time(file, error), 0};
    if (error) return {};
    time.size = std::filesystem::file_size(file, error);
    return error ? std::nullopt : std::optional(time);
}
}

std::vector<InputTime> input_times(const Scene& scene) {
    std::vector<std::filesystem::path> files;
    for (const InputFile& input : scene.inputs) files.push_back(input.path);
    for (const MediumSource& medium : scene.media)
        for (const FileSequence* sequence : volume_sequences(medium)) {
            if (sequence->files.empty()) files.push_back(sequence->pattern);
            for (const int number : sequence->files)
                if (const auto file = sequence_file(*sequence, number - sequence->offset, MissingFrame::hold))
                    files.push_back(*file);
        }
    for (const LightSource& light : scene.lights)
        if (light.gobo)
            for (const int number : light.gobo->sequence.files)
                files.push_back(gobo_file(*light.gobo, number - light.gobo->sequence.offset, MissingFrame::hold));
    std::vector<InputTime> times;
    for (const std::filesystem::path& file : files)
        if (const auto time = time_of(file)) times.push_back(*time);
    return times;
}

std::vector<std::filesystem::path> changed_inputs(std::span<const InputTime> known) {
    std::vector<std::filesystem::path> changed;
    for (const InputTime& before : known)
        if (const auto now = time_of(before.file); now && (now->written != before.written || now->size != before.size))
            changed.push_back(before.file);
    return changed;
}
}
