// A ray's story as JSON.
#pragma once
#include "measure/explain_report.h"

namespace tyndall {
std::string explain_json(const RayStory& story, const StoryTitle& title);
}
