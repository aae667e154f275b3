// The results of tyndall stress as text, JSON and HTML.
#pragma once
#include "common.h"

#include "measure/stress/stress.h"

namespace tyndall {
struct StressReport {
    std::vector<StressResult> results; // case by case
    std::vector<std::string> modes;    // columns, in the order of the mode table; "program" last
    double seconds = 0;
    size_t asked = 0; // cases to run; after a stop, results may have fewer

    int count(Verdict verdict) const;
    const StressResult* find(const StressCase& stress, const std::string& mode) const; // null: it did not take part
    std::vector<const StressCase*> cases() const;
};

std::string stress_summary(const StressReport& report); // one line
std::string stress_text(const StressReport& report);
std::string stress_json(const StressReport& report);
std::string stress_html(const StressReport& report);
std::string stress_list(std::span<const StressCase* const> cases); // names, titles and sweeps

// "0.1 m", "3": a value of the sweep.
std::string stress_value(const StressCase& stress, double value);
}
