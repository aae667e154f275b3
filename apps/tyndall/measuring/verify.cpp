// tyndall verify: checks that this program is correct, on built-in scenes or on the user's.
#include "measure/verify/verify.h"

#include "base/error.h"
#include "base/io/output.h"
#include "base/text.h"
#include "common.h"
#include "scene/scene.h"

#include <optional>

namespace tyndall {
namespace {
struct Options {
    std::string scene, frame, camera, resolution, samples, seed;
};

// Enough digits to see the tolerance.
std::string value_text(double value) { return formatted("%.7g", value); }

std::string table(const std::vector<Check>& checks) {
    std::string text, topic;
    for (const Check& check : checks) {
        if (check.topic != topic) text += formatted("%s%s\n", topic.empty() ? "" : "\n", check.topic.c_str());
        topic = check.topic;
        text += formatted("  %-4s %-58s %11s  expected %11s +- %-9.2g %s\n", check.holds() ? "ok" : "FAIL",
                          check.name.c_str(), value_text(check.measured).c_str(), value_text(check.expected).c_str(),
                          check.tolerance, check.basis.c_str());
    }
    return text;
}

std::string checks_json(const std::vector<Check>& checks, size_t off) {
    const auto check_json = [](const Check& check) {
        return json_object({{"topic", check.topic},
                            {"name", check.name},
                            {"measured", check.measured},
                            {"expected", check.expected},
                            {"tolerance", check.tolerance},
                            {"basis", check.basis},
                            {"holds", check.holds()}});
    };
    return json_line({{"version", TYNDALL_VERSION}, {"off", off}, {"checks", json_list(checks, check_json)}});
}

VerifyOptions proof_of(const Options& args) {
    VerifyOptions options;
    if (!args.resolution.empty()) options.size = resolution_option("--res", args.resolution);
    if (!args.samples.empty())
        options.samples = static_cast<int>(integer_option("--samples", args.samples, 64, 65536) + 63) / 64 * 64;
    if (!args.seed.empty()) options.seed = static_cast<uint32_t>(integer_option("--seed", args.seed, 0, UINT32_MAX));
    if (!args.frame.empty()) options.frame = frame_option(args.frame);
    options.camera = args.camera;
    return options;
}

void refuse_scene_options(const Options& args) {
    const std::pair<const char*, const std::string*> options[] = {{"--frame", &args.frame},
                                                                  {"--camera", &args.camera},
                                                                  {"--res", &args.resolution},
                                                                  {"--samples", &args.samples},
                                                                  {"--seed", &args.seed}};
    for (const auto& [name, text] : options)
        if (!text->empty()) fail(ExitCode::usage, name, "needs a scene: tyndall verify SCENE.json");
}

int run_verify(const Options& args, const Globals& globals) {
    VerifyOptions options = proof_of(args);
    if (args.scene.empty()) refuse_scene_options(args);
    std::optional<Scene> scene;
    if (!args.scene.empty()) scene = load_scene(args.scene);
    if (scene && scene->media.empty()) refuse(scene->file.string(), "has no fog to verify");
    if (scene && args.frame.empty()) options.frame = scene->first_frame;

    Progress progress(globals.progress, "verify", 1, globals.json);
    const VerifyControl control{&cancel_flag(), [&](double done) { progress.set(done); }};
    const std::vector<Check> checks = scene ? verify_scene(*scene, options, control) : verify_program(control);
    stop_if_cancelled();
    progress.finish();
    size_t off = 0;
    for (const Check& check : checks) off += !check.holds();
    print_report(globals.json ? checks_json(checks, off) : table(checks));
    if (!globals.quiet)
        say(count_text(checks.size(), "check") + ", " +
            (off ? std::to_string(off) + " failed" : std::string("all hold")));
    return static_cast<int>(off ? ExitCode::differs : ExitCode::ok);
}
}

Run add_verify(const Command& program) {
    const Command command = program.command("verify", "check the correctness of the program, or of a scene's images");
    auto args = std::make_shared<Options>();
    command.option("SCENE", args->scene, "a scene to check on its own data (default: only the program)", "");
    command.option("--frame", args->frame, "which frame of the scene (default: its first)", "N");
    command.option("--camera", args->camera, "which camera (default: the scene's)", "NAME");
    command.option("--res", args->resolution, "size of the images compared (default: 160x90)", "WxH");
    command.option("--samples", args->samples,
                   "paths per pixel, rounded up to a multiple of 64 (default: 256);\n"
                   "more of them find smaller differences",
                   "N");
    command.option("--seed", args->seed, "other random numbers (default: 0)", "N");
    command.footer("Examples: this program in half a minute; then a scene\n"
                   "  tyndall verify\n"
                   "  tyndall verify scenes/window.json --res 320x180 --samples 1024\n"
                   "Without a scene: closed forms, published tables, conservation of energy, invariances. With one:\n"
                   "same bits with any number of threads and for crops, units of length, lights that add up, the fog\n"
                   "in a white furnace, and the march against the path tracer's first order, tile by tile.\n"
                   "Exit code 0: all checks hold; 1: one failed.");
    return [args](const Globals& globals) { return run_verify(*args, globals); };
}
}
