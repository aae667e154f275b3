// tyndall modes: the rendering techniques, a line each; the settings of one, or all, with their values at each quality.
#include "base/error.h"
#include "common.h"
#include "modes/mode.h"
#include "modes/settings.h"

namespace tyndall {
namespace {
constexpr Quality qualities[] = {Quality::draft, Quality::preview, Quality::final, Quality::reference};

std::string range_of(const SettingRow& row) {
    if (row.choices.empty()) return formatted("%g to %g", row.low, row.high);
    return joined(row.choices, "|");
}

Json row_json(const SettingRow& row) {
    Json result = json_object({{"name", row.name}, {"unit", row.unit}, {"doc", row.doc}, {"advanced", row.advanced}});
    if (row.choices.empty()) {
        result.members.emplace_back("low", row.low);
        result.members.emplace_back("high", row.high);
        result.members.emplace_back("integer", row.integer);
    } else {
        result.members.emplace_back("choices", row.choices);
    }
    JsonMembers values;
    for (const Quality quality : qualities) values.emplace_back(name_of(quality), row.get(settings_for(quality)));
    result.members.emplace_back("values", json_object(std::move(values)));
    std::vector<std::string> readers;
    for (const Mode& mode : modes())
        if (reads(mode, row.name)) readers.emplace_back(mode.name);
    result.members.emplace_back("modes", readers);
    return result;
}

std::string modes_json(std::span<const Mode* const> shown, const std::vector<SettingRow>& rows) {
    const auto mode_json = [](const Mode* mode) {
        return json_object({{"name", mode->name},
                            {"promise", name_of(mode->accuracy)},
                            {"summary", mode->summary},
                            {"use", mode->use}});
    };
    return json_line({{"modes", json_list(shown, mode_json)}, {"settings", json_list(rows, row_json)}});
}

std::string rows_text(const std::vector<SettingRow>& rows) {
    std::string text = "\nSettings (--set NAME=VALUE) and their values at each --quality:\n" + formatted("  %-25s", "");
    for (const Quality quality : qualities) text += formatted(" %15s", std::string(name_of(quality)).c_str());
    text += "\n";
    for (const SettingRow& row : rows) {
        text += formatted("  %-25s", row.name.c_str());
        for (const Quality quality : qualities) text += formatted(" %15s", row.get(settings_for(quality)).c_str());
        text += "\n      " +
                wrapped(row.doc + " (" + range_of(row) + (row.unit.empty() ? "" : " " + row.unit) +
                            (row.advanced ? "; advanced)" : ")"),
                        113, 6) +
                "\n";
    }
    return text;
}

std::string table_text() {
    std::string text = "Modes (tyndall render --mode NAME), what each promises and how it works:\n";
    for (const Mode& mode : modes())
        text += formatted("  %-13s %-20s %s\n", std::string(mode.name).c_str(),
                          std::string(name_of(mode.accuracy)).c_str(), std::string(mode.summary).c_str());
    return text + "\ntyndall modes MODE shows what a mode is for and which settings it reads; --settings lists all "
                  "settings.\n";
}

std::string mode_text(const Mode& mode) {
    const auto line = [](const char* what, std::string_view text) {
        return formatted("  %-10s ", what) + wrapped(text, 106, 13) + "\n";
    };
    return std::string(mode.name) + "\n" + line("how", mode.summary) + line("promises", name_of(mode.accuracy)) +
           line("use it", "for " + std::string(mode.use)) +
           (mode.uses_history ? line("--history", "lets it use earlier frames") : "") +
           (mode.adds_fluence ? line("--orders", "adds multiple scattering") : "");
}
}

Run add_modes(const Command& program) {
    const Command command = program.command("modes", "the rendering techniques and their settings");
    const auto name = std::make_shared<std::string>();
    const auto settings = std::make_shared<bool>(false);
    command.option("MODE", *name, "show only this mode and the settings it reads (default: one line per mode)", "");
    command.flag("--settings", *settings, "also list all settings of all modes (--json always does)");
    command.footer("Example: what froxel is for, and its settings\n  tyndall modes froxel\n"
                   "Example: all settings as JSON, for a script\n  tyndall modes --json");
    return [name, settings](const Globals& globals) {
        std::vector<const Mode*> shown;
        std::vector<SettingRow> rows = setting_rows();
        if (name->empty()) {
            for (const Mode& mode : modes()) shown.push_back(&mode);
        } else {
            shown.push_back(&find_mode(*name));
            std::erase_if(rows, [&](const SettingRow& row) { return !reads(*shown[0], row.name); });
        }
        if (globals.json)
            print_report(modes_json(shown, rows));
        else
            print_report((name->empty() ? table_text() : mode_text(*shown[0])) +
                         (name->empty() && !*settings ? "" : rows_text(rows)));
        return 0;
    };
}
}
