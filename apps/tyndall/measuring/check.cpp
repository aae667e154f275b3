// tyndall check: finds problems in scenes, recipes, volumes and images, and prints a line for each.
#include "common.h"
#include "file_kind.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/io/frames.h"
#include "render/image/exr.h"
#include "scene/file/scene_file.h"
#include "scene/gltf/gltf.h"
#include "scene/input_files.h"
#include "scene/photometry/ies_file.h"
#include "trace/fog/grid_file.h"
#include "trace/lights/enclosed_lights.h"
#include "volume/bricks/bricks.h"
#include "volume/vdb/vdb.h"

#include <algorithm>
#include <set>

namespace tyndall {
namespace {
struct Problem {
    std::string file, text;
    bool unreadable = false;
};
using Problems = std::vector<Problem>;

// "FILE: FIELD: TEXT"; a message that already begins with the file keeps it once.
std::string problem_line(const Problem& problem) {
    const std::string file = printable(problem.file, 200);
    return problem.text.starts_with(file) ? problem.text : file + ": " + problem.text;
}

void check_vdb(const std::filesystem::path& file, const std::string& grid, Problems& problems) {
    VdbReadReport report;
    check_bricks(read_vdb(file, grid, &report));
    const std::string summary = report.summary();
    if (!summary.empty()) problems.push_back({file.string(), summary});
}

void check_exr(const std::filesystem::path& file, Problems& problems) {
    const ExrFile exr = read_exr(file);
    if (exr.attributes.contains("tyndall:check") && !exr.is_unchanged)
        problems.push_back({file.string(), "damaged or edited: its contents do not match its checksum"});
    if (const auto partial = exr.attributes.find("tyndall:partial"); partial != exr.attributes.end())
        problems.push_back({file.string(), "merged while parts were missing, from " + printable(partial->second, 80)});
    for (const auto& [name, image] : exr.channels) {
        uint64_t bad = 0;
        for (const float value : image.pixels) bad += std::isnan(value) || (std::isinf(value) && name != "Z");
        if (bad)
            problems.push_back({file.string(), "channel " + printable(name, 80) + ": " + std::to_string(bad) +
                                                   " pixels are not finite numbers"});
    }
}

// Runs one check; an error it throws is a problem of `file`.
template<class Check> void guarded(const std::string& file, Problems& problems, Check check) {
    stop_if_cancelled();
    try {
        check();
    } catch (const Error& error) {
        problems.push_back({file, error.what(), error.code == ExitCode::unreadable});
    }
}

// Checks the files of a sequence that the scene's frames use, each once.
template<class Check>
void check_frames(const std::string& file, const Scene& scene, const FileSequence& sequence,
                  std::span<const std::string> grids, Problems& problems, const Check& check) {
    std::set<std::filesystem::path> seen;
    std::vector<std::string> notes;
    for (int frame = scene.first_frame; frame <= scene.last_frame; ++frame)
        guarded(file, problems, [&] {
            const auto volume = grid_file(sequence, grids, frame, MissingFrame::error, notes);
            if (!volume || !seen.insert(*volume).second) return;
            VdbReadReport report;
            check(*volume, report);
            if (const std::string summary = report.summary(); !summary.empty())
                problems.push_back({volume->string(), summary});
        });
    for (const std::string& note : notes) // once, however many of the medium's grids are read from one file
        if (std::ranges::find(problems, note, &Problem::text) == problems.end()) problems.push_back({file, note});
}

// Checks every grid the scene reads. A density that neither extinction nor emission uses is skipped.
void check_media(const std::string& file, const Scene& scene, Problems& problems) {
    const auto some = [](const Keyed<float>& number) {
        return std::ranges::any_of(number.values, [](float value) { return value > 0; });
    };
    for (const MediumSource& medium : scene.media) {
        if (medium.kind != MediumKind::vdb) continue;
        if (some(medium.extinction) || (emits_light(medium) && !medium.blackbody && !medium.emission_grid))
            check_frames(file, scene, medium.sequence, density_grids(medium), problems,
                         [&](const auto& volume, VdbReadReport& report) {
                             const SparseVolume fog =
                                 read_vdb(volume, medium.density_grid, medium.density_map, infinity, &report);
                             within(volume.string(), [&] { check_bricks(fog); });
                         });
        for (const auto* grid : {&medium.albedo_grid, &medium.emission_grid, &medium.temperature, &medium.flame}) {
            if (!*grid) continue;
            check_frames(file, scene, (*grid)->sequence, (*grid)->grids, problems,
                         [&](const auto& volume, VdbReadReport& report) {
                             const bool is_albedo = grid == &medium.albedo_grid;
                             const ColorVolume color = read_color_vdb(volume, (*grid)->grids, (*grid)->map,
                                                                      is_albedo ? 1 : infinity, &report);
                             within(volume.string(), [&] {
                                 for (const SparseVolume& channel : color.channels) check_bricks(channel);
                             });
                         });
        }
        if (const auto& velocity = medium.velocity)
            check_frames(file, scene, velocity->grid.sequence, velocity->grid.grids, problems,
                         [&](const auto& volume, VdbReadReport& report) {
                             read_velocity_vdb(volume, velocity->grid.grids, velocity->grid.map, &report);
                         });
    }
}

// Checks the files of animated gobos that the scene's frames use, each once.
void check_gobos(const std::string& file, const Scene& scene, Problems& problems) {
    std::set<std::filesystem::path> seen;
    for (const LightSource& light : scene.lights)
        for (int frame = scene.first_frame; light.gobo && !light.gobo->still && frame <= scene.last_frame; ++frame)
            guarded(file, problems, [&] {
                const std::filesystem::path image = gobo_file(*light.gobo, frame, MissingFrame::error);
                std::string note;
                if (seen.insert(image).second)
                    make_gobo(read_file(image, largest_gobo_file), light.gobo->space, image.string(), note);
            });
}

// Reports lights that light nothing because geometry encloses them.
void check_lights(const std::string& file, const Scene& scene, Problems& problems) {
    guarded(file, problems, [&] {
        for (const std::string& line : enclosed_lights(scene)) problems.push_back({file, line});
    });
}

void check_scene(const std::string& file, Problems& problems) {
    const Scene scene = load_scene(file);
    for (const std::string& warning : scene.warnings) problems.push_back({file, warning});
    check_lights(file, scene, problems);
    check_media(file, scene, problems);
    check_gobos(file, scene, problems);
}

// Checks the file as a part of a scene: a lack of lights, fog or cameras is not a problem.
void check_gltf(const std::string& file, Problems& problems) {
    Scene scene;
    scene.file = file;
    load_gltf(file, {}, scene);
    for (const std::string& warning : scene.warnings) problems.push_back({file, warning});
    check_lights(file, scene, problems);
}

// Checks the files of a sequence for `frames`; if empty, for all frames from its first file to its last. Returns how
// many.
size_t check_sequence(const std::string& pattern, std::vector<int> frames, Problems& problems) {
    const FileSequence sequence = find_sequence(pattern, ".");
    if (frames.empty()) frames = frames_between(sequence.files.front(), sequence.files.back());
    for (const int frame : frames)
        guarded(pattern, problems, [&] {
            if (!std::ranges::count(sequence.files, frame))
                fail(ExitCode::unreadable, "", "frame " + std::to_string(frame) + " is missing");
            const auto file = sequence_file(sequence, frame, MissingFrame::error);
            if (file && file->extension() == ".exr")
                check_exr(file->string(), problems);
            else if (file)
                check_vdb(*file, "", problems);
        });
    return frames.size();
}

void check_file(const std::string& file, Problems& problems) {
    switch (file_kind(file)) {
    case FileKind::vdb:
        return check_vdb(file, "", problems);
    case FileKind::exr:
        return check_exr(file, problems);
    case FileKind::ies:
        for (const std::string& note : read_ies(read_file(file, largest_ies_file), file).notes)
            problems.push_back({file, note});
        return;
    case FileKind::recipe:
        return static_cast<void>(read_recipe(file));
    case FileKind::schema:
        return; // found beside scenes and recipes; only has to be valid JSON
    case FileKind::gltf:
        return check_gltf(file, problems);
    case FileKind::scene:
        return check_scene(file, problems);
    }
}

bool is_sequence(const std::string& file) {
    std::error_code ignored;
    const bool numbered = is_volume_name(file) || file.ends_with(".exr");
    return numbered && has_frame_token(file) && !std::filesystem::exists(file, ignored);
}

std::string problems_json(const std::vector<std::string>& files, const Problems& problems) {
    const auto problem_json = [](const Problem& problem) {
        return json_object({{"file", problem.file}, {"problem", problem.text}});
    };
    return json_line({{"files", files}, {"problems", json_list(problems, problem_json)}});
}

struct Options {
    std::vector<std::string> files;
    std::string frames;
};

int run_check(const Options& args, const Globals& globals) {
    const std::vector<std::string>& files = args.files;
    const std::vector<int> frames = args.frames.empty() ? std::vector<int>() : parse_frames(args.frames);
    if (!frames.empty() && !std::ranges::any_of(files, is_sequence))
        fail(ExitCode::usage, "--frames", "none of the files is a sequence, like x.####.exr");
    Problems problems;
    size_t checked = 0;
    for (const std::string& file : files) {
        size_t count = 1;
        guarded(file, problems, [&] {
            if (is_sequence(file))
                count = check_sequence(file, frames, problems);
            else
                check_file(file, problems);
        });
        checked += count;
    }

    std::string text;
    for (const Problem& problem : problems) text += problem_line(problem) + "\n";
    print_report(globals.json ? problems_json(files, problems) : text);
    if (!globals.quiet) say(count_text(checked, "file") + " checked, " + count_text(problems.size(), "problem"));
    const auto unreadable = [](const Problem& problem) { return problem.unreadable; };
    if (problems.empty()) return 0;
    const bool only_unreadable = std::all_of(problems.begin(), problems.end(), unreadable);
    return static_cast<int>(only_unreadable ? ExitCode::unreadable : ExitCode::differs);
}
}

Run add_check(const Command& program) {
    const Command command = program.command("check", "find problems in scenes, recipes, volumes and images");
    auto args = std::make_shared<Options>();
    command
        .options("FILES", args->files,
                 "files (.json .gltf .glb .vdb .nvdb .exr .ies); a name with #### is a whole sequence", "")
        .required();
    command.option("--frames", args->frames,
                   "frames a sequence should have (default: from the first found to the last)", "RANGE");
    command.footer("Example: before a long render\n"
                   "  tyndall check scenes/window.json 'fog/dust.####.vdb'\n"
                   "After one: are all frames present and complete?\n"
                   "  tyndall check 'out/shot.####.exr' --frames 1-24\n"
                   "Each problem is one line on stdout: FILE: FIELD: TEXT. Volumes and images are read whole.\n"
                   "Exit code 0: no problem; 1: problems, warnings too; 4: the only problems are files that are\n"
                   "missing or cannot be read.");
    return [args](const Globals& globals) { return run_check(*args, globals); };
}
}
