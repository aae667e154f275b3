// The modes' answers as text.
#include "measure/explain/text.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
std::string answer_text(const Answer& answer, const Answer* reference) {
    const std::string off = !answer.finite ? "not finite" : reference ? difference_text(answer, *reference) : "";
    return formatted("  %-14s %s %19s %9s %8s %8d\n", answer.mode.c_str(), color_columns(answer.inscatter).c_str(),
                     off.c_str(), percent(answer.transmittance).c_str(), percent(answer.validity).c_str(),
                     answer.steps);
}

// A limitation of one or more lights or media, and the modes that share it.
struct Said {
    std::vector<std::string> modes;
    LimitationGroup group;
};
}

std::string limitations_text(const RayStory& story) {
    std::vector<Said> all;
    for (const Answer& answer : story.answers)
        for (LimitationGroup& group : groups_of(answer.limitations)) {
            if (group.worst.severity == Severity::info) continue;
            const auto known = std::ranges::find(all, group, &Said::group);
            if (known != all.end())
                known->modes.push_back(answer.mode);
            else
                all.push_back({{answer.mode}, std::move(group)});
        }
    std::string text;
    for (const Said& said : all) text += wrapped("  " + joined(said.modes, ", ") + ": " + line_of(said.group), 6);
    return text.empty() ? text : "Limitations of the modes on this ray\n" + text;
}

std::string modes_text(const RayStory& story) {
    std::string text = "What each mode gives: fog light of one sample at the pixel's center, nits\n";
    text += formatted("  %-14s %s %19s %9s %8s %8s\n", "", channels().c_str(), "error", "through", "valid", "steps");
    text += answer_text(story.reference, nullptr);
    for (const Answer& answer : story.answers) text += answer_text(answer, &story.reference);
    for (const Answer& answer : story.answers)
        if (!answer.remark.empty()) text += wrapped(formatted("  %-14s ", answer.mode.c_str()) + answer.remark, 17);
    return text;
}
}
