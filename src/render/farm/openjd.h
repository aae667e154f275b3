// The job as a template of Open Job Description (jobtemplate-2023-09, extension TASK_CHUNKING), and the files it reads
// as Deadline Cloud's job bundles list them.
#pragma once
#include "render/farm/forecast.h"

namespace tyndall {
// JSON, which template.json may be. Throws Error (usage) for a word that OpenJD would take for a format string.
std::string openjd_template(const FarmJob& job, const TaskLimits& limits);

// JSON too, as which YAML is read: asset_references.yaml.
std::string openjd_asset_references(const FarmJob& job, const std::vector<std::filesystem::path>& inputs);
}
