// The modes' answers for people.
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

// The same words of one or more modes, about one or more lights or media.
struct Said {
    std::vector<std::string> modes, where;
    Severity severity;
    std::string why;
};

std::vector<Said> said_by(const Answer& answer) {
    std::vector<Said> all;
    for (const Limit& limit : answer.limits) {
        if (limit.severity == Severity::info) continue;
        const auto known = std::ranges::find_if(
            all, [&](const Said& said) { return said.severity == limit.severity && said.why == limit.why; });
        if (known != all.end())
            known->where.push_back(printable(limit.where));
        else
            all.push_back({{answer.mode}, {printable(limit.where)}, limit.severity, limit.why});
    }
    return all;
}
}

std::string limits_text(const RayStory& story) {
    constexpr size_t most_named = 5;
    std::vector<Said> all;
    for (const Answer& answer : story.answers)
        for (Said& said : said_by(answer)) {
            const auto known = std::ranges::find_if(all, [&](const Said& other) {
                return other.severity == said.severity && other.why == said.why && other.where == said.where;
            });
            if (known != all.end())
                known->modes.push_back(answer.mode);
            else
                all.push_back(std::move(said));
        }
    std::string text;
    for (Said& said : all) {
        const size_t more = said.where.size() > most_named ? said.where.size() - most_named : 0;
        said.where.resize(said.where.size() - more);
        std::string where = joined(said.where, ", ");
        if (more > 0) where += formatted(" and %zu more", more);
        text += wrapped("  " + joined(said.modes, ", ") + ": " + std::string(name_of(said.severity)) + ": " + where +
                            ": " + printable(said.why, 240),
                        6);
    }
    return text.empty() ? text : "What modes say of themselves here\n" + text;
}

std::string modes_text(const RayStory& story) {
    std::string text = "What each mode makes of it: fog light of one sample at the pixel's centre, nits\n";
    text += formatted("  %-14s %s %19s %9s %8s %8s\n", "", channels().c_str(), "off", "through", "valid", "steps");
    text += answer_text(story.reference, nullptr);
    for (const Answer& answer : story.answers) text += answer_text(answer, &story.reference);
    for (const Answer& answer : story.answers)
        if (!answer.remark.empty()) text += wrapped(formatted("  %-14s ", answer.mode.c_str()) + answer.remark, 17);
    return text;
}
}
