// tyndall view: starts the viewer, a separate program in the same folder.
#include "base/error.h"
#include "common.h"

#include <cerrno>
#include <cstring>

#include <unistd.h>

namespace tyndall {
namespace {
constexpr const char* viewer_program = "tyndall-view";
}

int start_viewer(std::vector<std::string> arguments) {
    std::error_code ignored;
    const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", ignored);
    const std::string viewer = (own.parent_path() / viewer_program).string();
    if (!std::filesystem::exists(viewer, ignored))
        fail(ExitCode::unreadable, viewer,
             "the viewer is not installed; it is only built where GLFW and Dear ImGui are found");
    arguments.insert(arguments.begin(), viewer_program);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(viewer.c_str(), pointers.data());
    fail(ExitCode::unreadable, viewer, std::strerror(errno));
}

Run add_view(const Command& program) {
    const Command command = program.command("view", "open a scene in the interactive viewer");
    command.pass_on();
    return [command](const Globals&) { return start_viewer(command.passed_on()); };
}
}
