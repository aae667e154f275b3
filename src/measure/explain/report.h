// A ray's story as text, as a drawing and as a table.
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

// A drawing that needs nothing else: fog, transmittance, light per metre and lit stretches over one axis of distance,
// and the modes' answers beside the reference.
std::string explain_svg(const RayStory& story, const StoryTitle& title);

// Every step, with what each light does there.
std::string explain_csv(const RayStory& story);

// Numbers of a report: four digits, and shares in percent.
std::string digits(double value);
std::string percent(double share);
// "+3.1 %", with the standard error of a noisy answer; what an answer is off the reference.
std::string difference_text(const Answer& answer, const Answer& reference);

// Light of all sources that a step adds at the eye.
vec3 added_by(const RayStory& story, size_t step);
}
