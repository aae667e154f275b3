// The parts of the text report. Internal to it.
#pragma once
#include "measure/explain/report.h"

namespace tyndall {
// "0.1 0.2 0.3", and three numbers in columns.
std::string color_text(vec3 v);
std::string color_columns(vec3 v);
std::string channels(); // the heading of such columns

std::string cut(std::string text, size_t most);

// Wraps text into lines of up to 100 columns; those after the first are indented.
std::string report_lines(const std::string& text, size_t indent);

std::string steps_text(const RayReport& report);       // the table of steps, merged into a few rows
std::string modes_text(const RayReport& report);       // the modes' results beside the reference
std::string limitations_text(const RayReport& report); // the modes' limitations on this ray
}
