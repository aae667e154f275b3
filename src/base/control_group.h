// Limits that a control group (cgroup v2) sets, such as a farm's job or a container.
#pragma once
#include <string>
#include <vector>

namespace tyndall {
// The first line of a file such as "memory.max" in the process's group and in each ancestor, all of which apply; empty
// where there is none.
std::vector<std::string> control_group_lines(const std::string& file);
}
