// What the report for people is made of. Internal to it.
#pragma once
#include "measure/explain/report.h"

namespace tyndall {
// "0.1 0.2 0.3", and three numbers in columns.
std::string color_text(vec3 v);
std::string color_columns(vec3 v);
std::string channels(); // what such columns are headed by

std::string cut(std::string text, size_t most);

// Words in lines of up to 100 columns; those after the first begin `indent` columns in.
std::string wrapped(const std::string& text, size_t indent);

std::string steps_text(const RayStory& story);       // the table of steps, put together to a few rows
std::string modes_text(const RayStory& story);       // the modes' answers beside the reference
std::string limitations_text(const RayStory& story); // what modes say of themselves
}
