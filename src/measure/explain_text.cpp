// The report for people.
#include "measure/explain_report.h"

#include "base/error.h"
#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr size_t columns = 100;
constexpr int most_rows = 20;            // of the table of steps
constexpr size_t most_light_columns = 4; // of the table of steps

std::string color_text(vec3 v) { return digits(v.x) + " " + digits(v.y) + " " + digits(v.z); }

// Three numbers below each other's.
std::string color_columns(vec3 v) {
    return formatted("%9s %9s %9s", digits(v.x).c_str(), digits(v.y).c_str(), digits(v.z).c_str());
}

std::string channels() { return formatted("%9s %9s %9s", "R", "G", "B"); }

std::string cut(std::string text, size_t most) { return text.size() <= most ? text : text.substr(0, most - 1) + "~"; }

// Words in lines of up to 100 columns; those after the first begin `indent` columns in.
std::string wrapped(const std::string& text, size_t indent) {
    std::string result, line;
    for (size_t start = 0; start < text.size();) {
        const size_t space = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, space - start);
        if (!line.empty() && line.size() + 1 + word.size() > columns) {
            result += line + "\n";
            line = std::string(indent, ' ') + word;
        } else {
            line += (start == 0 ? "" : " ") + word;
        }
        start = space + 1;
    }
    return result + line + "\n";
}

std::string surface_text(const SurfaceOnRay& surface) {
    std::string text = formatted("  %9s m  ", digits(surface.distance).c_str()) + printable(surface.name, 40);
    if (!surface.material.empty()) text += " (" + printable(surface.material, 40) + ")";
    if (surface.alpha < 1) text += ", alpha " + digits(surface.alpha);
    return wrapped(
        text + ": radiance " + color_text(surface.radiance) + ", " + percent(surface.share) + " of it arrives", 13);
}

std::string ray_text(const RayStory& story) {
    std::string text = "The ray\n";
    text += "  from " + color_text(story.origin) + " m towards " + color_text(story.direction) + "\n";
    if (story.steps.empty()) {
        text += "  no fog on its way\n";
    } else {
        std::string media;
        for (const MediumOnRay& medium : story.media)
            if (medium.depth > 0)
                media += (media.empty() ? "" : " + ") + printable(medium.name, 40) + " " + digits(medium.depth);
        text += wrapped("  fog from " + digits(story.steps.front().low) + " to " + digits(story.steps.back().high) +
                            " m, optical depth " + digits(story.depth) + " (" + media +
                            "): " + percent(story.reference.transmittance) + " of the light behind it comes through",
                        6);
    }
    for (const SurfaceOnRay& surface : story.surfaces) text += surface_text(surface);
    if (!story.hits)
        text += "     behind    background: radiance " + color_text(story.background) + ", " +
                percent(story.background_share) + " of it arrives\n";
    return text;
}

const char* kind_text(LightKind kind) {
    return kind == LightKind::sun ? "sun" : kind == LightKind::spot ? "spot" : "point";
}

// Metres of the ray on which a light does this.
double length_of(const LightOnRay& light, Lighting state) {
    double sum = 0;
    for (const LightStretch& stretch : light.stretches)
        if (stretch.state == state) sum += stretch.high - stretch.low;
    return sum;
}

std::string lights_text(const RayStory& story) {
    std::string text = "Light that arrives, nits (other: ambient light, emission, background)\n";
    text += formatted("  %-16s %-5s %29s %29s\n", "", "", "scattered by fog", "reflected by surfaces");
    text += formatted("  %-16s %-5s %s %s %8s\n", "", "", channels().c_str(), channels().c_str(), "lit, m");
    const auto row = [&](const std::string& name, const char* kind, vec3 fog, vec3 surfaces, const std::string& lit) {
        text += formatted("  %-16s %-5s %s %s %8s\n", cut(printable(name, 40), 16).c_str(), kind,
                          color_columns(fog).c_str(), color_columns(surfaces).c_str(), lit.c_str());
    };
    vec3 of_lights(0);
    for (const LightOnRay& light : story.lights) {
        row(light.name, kind_text(light.kind), light.fog, light.surfaces, digits(length_of(light, Lighting::full)));
        of_lights += light.surfaces;
    }
    const vec3 behind = story.reference.color - story.reference.inscatter;
    row("other", "", story.glow, glm::max(behind - of_lights, vec3(0)), "");
    row("all", "", story.reference.inscatter, behind, "");
    return text;
}

std::string stretches_text(const RayStory& story) {
    std::string text = "Where each light comes in\n";
    for (const LightOnRay& light : story.lights) {
        std::string name = cut(printable(light.name, 40), 16);
        for (const LightStretch& stretch : light.stretches) {
            std::string line = formatted("  %-16s %9.3f %9.3f m   ", name.c_str(), stretch.low, stretch.high);
            line += name_of(stretch.state);
            if (!stretch.blockers.empty()) line += " of " + printable(joined(stretch.blockers, ", "), 200);
            if (stretch.state == Lighting::partial) line += ", " + percent(stretch.share) + " comes in";
            text += wrapped(line, 45);
            name.clear();
        }
    }
    if (!story.steps.empty() && std::ranges::any_of(story.lights, &LightOnRay::sampled))
        text += "  (shadows of MASK and BLEND surfaces are as the steps see them)\n";
    return text;
}

// Steps put together over one stretch of the ray.
struct Row {
    double low = 0, high = 0, depth = 0, reach = 0;
    dvec3 source{0}, added{0};           // per metre, times metres; at the eye
    std::vector<double> share, to_light; // of each light, times metres
};

Row row_of(const RayStory& story, double low, double high) {
    Row row{low,
            high,
            0,
            0,
            dvec3(0),
            dvec3(0),
            std::vector<double>(story.lights.size()),
            std::vector<double>(story.lights.size())};
    for (size_t i = 0; i < story.steps.size(); ++i) {
        const RayStep& step = story.steps[i];
        const double length = std::min(high, step.high) - std::max(low, step.low);
        if (!(length > 0)) continue;
        const double part = length / (step.high - step.low);
        row.depth += step.extinction * length, row.reach += step.reach * part;
        row.source += length * dvec3(step.glow), row.added += part * dvec3(added_by(story, i));
        for (size_t l = 0; l < story.lights.size(); ++l) {
            row.source += length * dvec3(story.lights[l].at[i].scattered);
            row.share[l] += length * story.lights[l].at[i].share;
            row.to_light[l] += length * story.lights[l].at[i].transmittance;
        }
    }
    return row;
}

// Ends of rows at round distances.
std::vector<double> row_ends(const RayStory& story) {
    const double low = story.steps.front().low, high = story.steps.back().high;
    double length = std::pow(10.0, std::floor(std::log10((high - low) / most_rows)));
    for (const double factor : {2.0, 2.5, 2.0})
        if ((high - low) / length > most_rows - 1) length *= factor;
    std::vector<double> ends{low};
    for (double end = (std::floor(low / length) + 1) * length; end < high; end += length) ends.push_back(end);
    ends.push_back(high);
    return ends;
}

// The lights that give most of the fog's light.
std::vector<size_t> main_lights(const RayStory& story) {
    std::vector<size_t> all;
    for (size_t l = 0; l < story.lights.size(); ++l)
        if (luminance(story.lights[l].fog) > 0) all.push_back(l);
    std::ranges::stable_sort(
        all, [&](size_t a, size_t b) { return luminance(story.lights[a].fog) > luminance(story.lights[b].fog); });
    all.resize(std::min(all.size(), most_light_columns));
    return all;
}

std::string steps_text(const RayStory& story) {
    if (story.steps.empty()) return {};
    const std::vector<size_t> lights = main_lights(story);
    const bool both = 2 * lights.size() <= most_light_columns;
    std::string text = "Step by step (luminance, nits)\n";
    if (!lights.empty()) text += std::string(67, ' ');
    for (const size_t l : lights)
        text += formatted(both ? " %17s" : " %8s", cut(printable(story.lights[l].name, 40), both ? 17 : 8).c_str());
    if (!lights.empty()) text += "\n";
    text += formatted("  %8s %8s %9s %8s %8s %10s %10s", "from, m", "to, m", "fog, 1/m", "depth", "to eye", "per metre",
                      "arrives");
    for (size_t l = 0; l < lights.size(); ++l) text += formatted(both ? " %8s %8s" : " %8s", "lit", "to light");
    text += "\n";
    dvec3 sum(0);
    double depth = 0;
    const std::vector<double> ends = row_ends(story);
    for (size_t i = 0; i + 1 < ends.size(); ++i) {
        const Row row = row_of(story, ends[i], ends[i + 1]);
        const double length = row.high - row.low;
        depth += row.depth, sum += row.added;
        text +=
            formatted("  %8.3f %8.3f %9s %8s %8s %10s %10s", row.low, row.high, digits(row.depth / length).c_str(),
                      digits(depth).c_str(), percent(row.reach / length).c_str(),
                      digits(luminance(vec3(row.source / length))).c_str(), digits(luminance(vec3(row.added))).c_str());
        for (const size_t l : lights) {
            text += formatted(" %8s", percent(row.share[l] / length).c_str());
            if (both) text += formatted(" %8s", percent(row.to_light[l] / length).c_str());
        }
        text += "\n";
    }
    const double all = luminance(vec3(sum)), exact = luminance(story.reference.inscatter);
    text += formatted("  %zu steps add up to %s, the reference is %s", story.steps.size(), digits(all).c_str(),
                      digits(exact).c_str());
    if (exact > 0) text += formatted(": off by %.2f %%", 100 * std::abs(all / exact - 1));
    return text + "\n";
}

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

// What modes say of themselves; what several say once.
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

std::string digits(double value) { return formatted("%.4g", value); }

std::string percent(double share) {
    const double value = 100 * share;
    return formatted(value == 0 || value >= 99.95 ? "%.0f %%"
                     : value < 0.01               ? "%.0e %%"
                     : value < 10                 ? "%.2f %%"
                                                  : "%.1f %%",
                     value);
}

std::string difference_text(const Answer& answer, const Answer& reference) {
    const double off = difference(answer, reference);
    if (std::isinf(off)) return "none expected";
    const auto text = [](double value, const char* sign) {
        const double size = std::abs(100 * value);
        return formatted(size >= 100 ? "%s%.0f" : size >= 10 ? "%s%.1f" : "%s%.2f", sign, size);
    };
    std::string result = std::abs(off) < 5e-5 ? "0.00" : text(off, off < 0 ? "-" : "+");
    if (answer.standard_error && luminance(reference.inscatter) > 0)
        result += " +- " + text(luminance(*answer.standard_error) / luminance(reference.inscatter), "");
    return result + " %";
}

vec3 added_by(const RayStory& story, size_t step) {
    vec3 sum = story.steps[step].glow;
    for (const LightOnRay& light : story.lights) sum += light.at[step].scattered;
    return static_cast<float>(story.steps[step].reach) * sum;
}

std::string title_line(const RayStory& story, const StoryTitle& title) {
    std::string text = printable(title.scene, 60) + formatted(", frame %d", title.frame);
    if (!title.camera.empty()) text += ", camera " + printable(title.camera, 40);
    return text + formatted(", pixel %d,%d of %dx%d, ", story.pixel.x, story.pixel.y, story.size.x, story.size.y) +
           title.quality;
}

std::string explain_text(const RayStory& story, const StoryTitle& title) {
    std::string text = wrapped(title_line(story, title), 2);
    for (const std::string& part : {ray_text(story), lights_text(story), stretches_text(story), steps_text(story),
                                    modes_text(story), limits_text(story)})
        if (!part.empty()) text += "\n" + part;
    // Empty cells leave no blanks at the ends of lines.
    std::string result;
    for (const char c : text) {
        if (c == '\n')
            while (result.ends_with(' ')) result.pop_back();
        result += c;
    }
    return result;
}
}
