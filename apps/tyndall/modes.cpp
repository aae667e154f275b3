// tyndall modes: the rendering techniques and every setting with its value at each quality.
#include "base/error.h"
#include "common.h"
#include "modes/mode.h"
#include "modes/settings.h"

namespace tyndall {
namespace {
constexpr Quality qualities[] = {Quality::draft, Quality::preview, Quality::final, Quality::reference};

std::string range_of(const SettingRow& row) {
    if (row.choices.empty()) return formatted("%g to %g", row.low, row.high);
    std::string text;
    for (const std::string& choice : row.choices) text += (text.empty() ? "" : "|") + choice;
    return text;
}

Json json_of_row(const SettingRow& row) {
    Json result = json_object({{"name", json_of(std::string_view(row.name))},
                               {"unit", json_of(std::string_view(row.unit))},
                               {"doc", json_of(std::string_view(row.doc))}});
    if (row.choices.empty()) {
        result.members.emplace_back("low", json_of(row.low));
        result.members.emplace_back("high", json_of(row.high));
        result.members.emplace_back("integer", json_of(row.integer));
    } else {
        result.members.emplace_back("choices", json_of(row.choices));
    }
    std::vector<std::pair<std::string, std::string>> values;
    for (const Quality quality : qualities)
        values.emplace_back(std::string(name_of(quality)), row.get(settings_for(quality)));
    result.members.emplace_back("values", json_of(values));
    return result;
}

std::string modes_json() {
    std::vector<Json> techniques, rows;
    for (const Mode& mode : modes())
        techniques.push_back(json_object({{"name", json_of(mode.name)},
                                          {"promise", json_of(name_of(mode.accuracy))},
                                          {"summary", json_of(mode.summary)}}));
    for (const SettingRow& row : setting_rows()) rows.push_back(json_of_row(row));
    return format_json(json_object({{"modes", json_array(techniques)}, {"settings", json_array(rows)}})) + "\n";
}

std::string modes_text() {
    std::string text = "Modes (tyndall render --mode NAME), what each promises and how it works:\n";
    for (const Mode& mode : modes())
        text += formatted("  %-12s %-20s %s\n", std::string(mode.name).c_str(),
                          std::string(name_of(mode.accuracy)).c_str(), std::string(mode.summary).c_str());
    text += "\nSettings (--set NAME=VALUE) and their values at each --quality:\n" + formatted("  %-25s", "");
    for (const Quality quality : qualities) text += formatted(" %15s", std::string(name_of(quality)).c_str());
    text += "\n";
    for (const SettingRow& row : setting_rows()) {
        text += formatted("  %-25s", row.name.c_str());
        for (const Quality quality : qualities) text += formatted(" %15s", row.get(settings_for(quality)).c_str());
        text += "\n      " + row.doc + " (" + range_of(row) + (row.unit.empty() ? "" : " " + row.unit) + ")\n";
    }
    return text;
}
}

Run add_modes(const Command& program) {
    const Command command = program.command("modes", "the rendering techniques and their settings");
    command.footer("Example: all settings as JSON, for a script\n  tyndall modes --json");
    return [](const Globals& globals) {
        print_report(globals.json ? modes_json() : modes_text());
        return 0;
    };
}
}
