// A job as an Open Job Description template (jobtemplate-2023-09, extension TASK_CHUNKING), and its input files as
// Deadline Cloud's job bundles list them.
#pragma once
#include "render/farm/forecast.h"

namespace tyndall {
// The content of template.json. Throws Error (usage) for a word that OpenJD would take for a format string.
std::string openjd_template(const FarmJob& job, const TaskLimits& limits);

// The content of asset_references.yaml: JSON, which is valid YAML.
std::string openjd_asset_references(const FarmJob& job, const std::vector<std::filesystem::path>& inputs);
}
