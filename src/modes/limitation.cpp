#include "modes/limitation.h"

#include "base/error.h"
#include "base/json/json_values.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr size_t max_named = 3; // names listed per group
constexpr size_t max_name = 60; // bytes

std::string_view word_of(Subject subject) {
    constexpr std::string_view words[] = {"scene",  "image",    "surfaces", "camera", "light",
                                          "medium", "material", "card",     "setting"};
    return words[static_cast<size_t>(subject)];
}

std::string plural_of(Subject subject) {
    return subject == Subject::medium ? "media" : std::string(word_of(subject)) + "s";
}
}

std::vector<LimitationGroup> groups_of(std::span<const Limitation> limitations) {
    std::vector<LimitationGroup> groups;
    for (const Limitation& one : limitations) {
        const auto alike = [&](const LimitationGroup& group) {
            return group.worst.kind == one.kind && group.worst.severity == one.severity &&
                   group.worst.subject == one.subject;
        };
        const auto known = std::ranges::find_if(groups, alike);
        if (known == groups.end()) {
            groups.push_back({one, {one.name}});
            continue;
        }
        known->names.push_back(one.name);
        if (one.amounts[0] > known->worst.amounts[0]) known->worst = one;
    }
    return groups;
}

std::string_view name_of(Severity severity) {
    constexpr std::string_view names[] = {"info", "degraded", "wrong"};
    return names[static_cast<size_t>(severity)];
}

std::string where_of(const Limitation& limitation) {
    const std::string name = printable(limitation.name, max_name);
    const std::string word(word_of(limitation.subject));
    if (limitation.subject == Subject::setting || name == word || name.starts_with(word + " "))
        return name; // "medium 1", "camera": the name says it
    return name.empty() ? word : word + " " + name;
}

std::string where_of(const LimitationGroup& group) {
    if (group.names.size() == 1) return where_of(group.worst);
    std::vector<std::string> names;
    for (const std::string& name : group.names)
        if (names.size() < max_named) names.push_back(printable(name, max_name));
    if (group.names.size() > max_named) names.push_back("...");
    return std::to_string(group.names.size()) + " " + plural_of(group.worst.subject) + " (" + joined(names, ", ") + ")";
}

// Two significant digits, without an exponent: 0.012, 3.4, 160.
std::string amount_text(double amount) {
    if (!(std::abs(amount) >= 99.5 && std::abs(amount) < 1e12)) return formatted("%.2g", amount);
    const double unit = std::pow(10, std::floor(std::log10(std::abs(amount))) - 1);
    return formatted("%.0f", std::round(amount / unit) * unit);
}

std::string sentence_of(const Limitation& limitation) {
    std::string text;
    size_t used = 0;
    for (std::string_view rest = limitation.kind->sentence; !rest.empty();) {
        const size_t open = std::min(rest.find('{'), rest.size());
        text += rest.substr(0, open);
        rest.remove_prefix(open);
        if (rest.empty()) break;
        text += rest.starts_with("{n}") ? formatted("%.0f", limitation.amounts.at(used))
                                        : amount_text(limitation.amounts.at(used));
        ++used;
        rest.remove_prefix(rest.find('}') + 1);
    }
    return text;
}

std::string line_of(const LimitationGroup& group) {
    return std::string(name_of(group.worst.severity)) + ": " + where_of(group) + ": " + sentence_of(group.worst) +
           " (" + std::string(group.worst.kind->id) + ")";
}

std::span<const double> amounts_of(const Limitation& limitation) {
    const auto named = std::ranges::count(limitation.kind->sentence, '{');
    return std::span(limitation.amounts).first(static_cast<size_t>(named));
}

Json json_of(const Limitations& limitations) {
    return json_list(groups_of(limitations), [](const LimitationGroup& group) {
        return json_object({{"severity", name_of(group.worst.severity)},
                            {"id", group.worst.kind->id},
                            {"where", where_of(group)},
                            {"names", json_list(group.names, [](const std::string& name) { return Json(name); })},
                            {"amounts", json_list(amounts_of(group.worst), [](double amount) { return Json(amount); })},
                            {"why", sentence_of(group.worst)}});
    });
}
}
