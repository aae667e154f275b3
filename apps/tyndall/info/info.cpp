// tyndall info: what is in a file.
#include "reports.h"

#include "base/error.h"
#include "common.h"
#include "file_kind.h"

namespace tyndall {
namespace {
std::string report_of(const std::string& file, bool json) {
    switch (file_kind(file)) {
    case FileKind::vdb:
        return vdb_report(file, json);
    case FileKind::gltf:
        return gltf_report(file, json);
    case FileKind::scene:
        return scene_report(file, json);
    case FileKind::recipe:
        return recipe_report(file, json);
    case FileKind::exr:
        return exr_report(file, json);
    case FileKind::ies:
        return ies_report(file, json);
    case FileKind::schema:
        break;
    }
    refuse(file, "a JSON schema, for editors; there is nothing to render or bake");
}
}

Run add_info(const Command& program) {
    const Command command = program.command("info", "what is in a file: grids, lights, cameras, layers, photometry");
    auto file = std::make_shared<std::string>();
    command.option("FILE", *file, "a .vdb, .nvdb, .gltf, .glb, .exr, .ies, or a scene or recipe (.json)", "")
        .required();
    command.footer("Example: the grids of a volume, their size in the world and how dense they are\n"
                   "  tyndall info fog.0001.vdb\n"
                   "With --json the same for scripts; lengths in meters, light in candela and lux.");
    return [file](const Globals& globals) {
        print_report(report_of(*file, globals.json));
        return 0;
    };
}
}
