// The explanation of a ray as JSON.
#pragma once
#include "measure/explain/report.h"

namespace tyndall {
std::string explain_json(const RayReport& report, const ReportTitle& title);
}
