// The explanation of a ray as text, as a drawing and as a table.
#pragma once
#include "measure/explain/explain.h"

namespace tyndall {
struct StoryTitle {
    std::string scene, camera, quality;
    int frame = 1;
};
std::string title_line(const RayStory& story, const StoryTitle& title);

// For people, in lines of up to 100 columns.
std::string explain_text(const RayStory& story, const StoryTitle& title);

// A self-contained SVG: fog, transmittance, light per meter and lit stretches over a common distance axis, and the
// modes' answers beside the reference.
std::string explain_svg(const RayStory& story, const StoryTitle& title);

// CSV of every step, with what each light contributes.
std::string explain_csv(const RayStory& story);

// Numbers of a report: four digits, and shares in percent.
std::string digits(double value);
std::string percent(double share);
// An answer's difference from the reference: "+3.1 %", with the standard error of a noisy answer.
std::string difference_text(const Answer& answer, const Answer& reference);

// Light that a step adds at the eye, from all sources.
vec3 added_by(const RayStory& story, size_t step);
}
