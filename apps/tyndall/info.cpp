// tyndall info: what is in a file.
#include "info.h"
#include "common.h"
#include "file_kind.h"

namespace tyndall {
namespace {
int run_info(const std::string& file, const Globals& globals) {
    std::string report;
    switch (file_kind(file)) {
    case FileKind::vdb:
        report = vdb_report(file, globals.json);
        break;
    case FileKind::gltf:
        report = gltf_report(file, globals.json);
        break;
    case FileKind::scene:
        report = scene_report(file, globals.json);
        break;
    case FileKind::recipe:
        report = recipe_report(file, globals.json);
        break;
    case FileKind::exr:
        report = exr_report(file, globals.json);
        break;
    }
    print_report(report);
    return 0;
}
}

Run add_info(CLI::App& app) {
    CLI::App* command = app.add_subcommand("info", "what is in a file: grids, lights, cameras, layers");
    auto file = std::make_shared<std::string>();
    command->add_option("FILE", *file, "a .vdb, .gltf, .glb, .exr, or a scene or recipe (.json)")
        ->type_name("")
        ->required();
    command->footer("Example: the grids of a volume, their size in the world and how dense they are\n"
                    "  tyndall info fog.0001.vdb\n"
                    "With --json the same for scripts; lengths in metres, light in candela and lux.");
    return [file](const Globals& globals) { return run_info(*file, globals); };
}
}
