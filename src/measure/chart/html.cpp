// The HTML page of a chart.
#include "base/text.h"
#include "measure/chart/page.h"
#include "measure/chart/report.h"
#include "measure/report/svg.h"

#include "base/io/file.h"

#include <algorithm>

namespace tyndall {
namespace {
// RFC 4648.
std::string base64(std::string_view bytes) {
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t three = 0;
        for (size_t k = 0; k < 3; ++k)
            three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : letters[three >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string element(const std::string& name, const std::string& content) {
    return "<" + name + ">" + content + "</" + name.substr(0, name.find(' ')) + ">";
}

std::string number_words(double value) { return std::isfinite(value) ? formatted("%.3g", value) : "-"; }

std::string size_words(ivec2 size) { return std::to_string(size.x) + " × " + std::to_string(size.y); }

std::string point_words(const ChartPoint& point) {
    return point.mode + " " + std::to_string(static_cast<int>(point.rung));
}

// --- what to use when --------------------------------------------------------------------------------------------
std::string answer_cell(const std::optional<ChartPoint>& point, FrameTime time, ErrorOf what) {
    if (!point) return element("td class=\"words\"", "none of these");
    return element("td class=\"words\" title=\"" + xml_text(point->settings) + "\"",
                   "<b>" + point_words(*point) + "</b>: " + percent_label(error_of(*point, what)) + " in " +
                       seconds_label(seconds_of(*point, time)));
}

std::string advice_table(const Chart& chart) {
    std::string rows;
    for (const Advice& advice : advice_of(chart))
        rows += "<tr>" + element("td", goal_text(advice)) +
                answer_cell(advice.single, FrameTime::single, ErrorOf::worse) +
                answer_cell(advice.sequence, FrameTime::sequence, ErrorOf::worse) +
                answer_cell(advice.fog, FrameTime::single, ErrorOf::fog) + "</tr>\n";
    return "<table><thead><tr><th>goal</th><th class=\"words\">by E, for a single frame</th>"
           "<th class=\"words\">by E, for each of 100 frames</th><th class=\"words\">by the fog light at pixel "
           "centers, "
           "for a single frame</th></tr></thead><tbody>\n" +
           rows + "</tbody></table>\n";
}

std::string skipped(const Chart& chart) {
    if (chart.skipped.empty()) return {};
    std::string list;
    for (const SkippedRung& rung : chart.skipped) list += element("li", xml_text(skipped_text(rung)));
    return element("p", xml_text(skip_reason(chart)) + ":") + element("ul class=\"quiet\"", list);
}

// --- all numbers ---------------------------------------------------------------------------------------------------
struct Column {
    const char* head;
    std::string (*cell)(const ChartPoint&);
};

const std::vector<Column>& columns() {
    using P = ChartPoint;
    static const std::vector<Column> all{
        {"rays per pixel", [](const P& p) { return number_words(p.samples); }},
        {"set-up", [](const P& p) { return seconds_label(p.setup_seconds); }},
        {"frame", [](const P& p) { return seconds_label(p.frame_seconds); }},
        {"fastest to slowest",
         [](const P& p) { return seconds_label(p.frame_fastest) + " to " + seconds_label(p.frame_slowest); }},
        {"single frame", [](const P& p) { return seconds_label(p.seconds_1); }},
        {"each of 100", [](const P& p) { return seconds_label(p.seconds_100); }},
        {"processor time", [](const P& p) { return seconds_label(p.cpu_seconds); }},
        {"memory", [](const P& p) { return bytes_label(p.memory_bytes); }},
        {"error E", [](const P& p) { return percent_label(p.errors.error); }},
        {"uncertainty", [](const P& p) { return percent_label(p.errors.uncertainty); }},
        {"rmse_rel", [](const P& p) { return percent_label(p.errors.rmse); }},
        {"rmse_rel of the fog light", [](const P& p) { return percent_label(p.errors.inscatter_rmse); }},
        {"fog light at pixel centers", [](const P& p) { return percent_label(p.fog_error); }},
        {"bias", [](const P& p) { return percent_label(p.errors.bias); }},
        {"relMSE", [](const P& p) { return number_words(p.errors.rel_mse); }},
        {"FLIP", [](const P& p) { return number_words(p.errors.flip); }},
        {"flicker", [](const P& p) { return percent_label(p.flicker); }},
        {"fitted gain", [](const P& p) { return number_words(p.gain); }},
        {"E with gain", [](const P& p) { return percent_label(p.fitted.error); }},
        {"fog light at pixel centers with gain", [](const P& p) { return percent_label(p.fitted_fog_error); }},
        {"FLIP with gain", [](const P& p) { return number_words(p.fitted.flip); }},
        {"unbeaten", [](const P& p) { return std::string(p.best_1 > 0 ? "yes" : "-"); }},
    };
    return all;
}

std::string number_table(const Chart& chart) {
    std::string head = "<th>mode, rung</th>", rows;
    for (const Column& column : columns()) head += element("th", column.head);
    for (const ChartPoint& point : chart.points) {
        rows += "<tr id=\"row-" + point_name(point) + "\" data-settings=\"" + xml_text(point.settings) + "\">" +
                element("td", point_words(point));
        for (const Column& column : columns()) rows += element("td", column.cell(point));
        rows += "</tr>\n";
    }
    return "<div class=\"wide\"><table><thead><tr>" + head + "</tr></thead><tbody>\n" + rows +
           "</tbody></table></div>\n";
}

// --- pictures ------------------------------------------------------------------------------------------------------
std::string image(const std::filesystem::path& file, const std::string& words) {
    return "<img alt=\"" + xml_text(words) + "\" src=\"data:image/jpeg;base64," + base64(read_file(file)) + "\">";
}

std::string gallery(const Chart& chart) {
    std::string html;
    for (const ChartedMode& mode : chart.modes) {
        html += element("h3", xml_text(mode.name) + " <span class=\"quiet\">(" + std::string(name_of(mode.accuracy)) +
                                  ") " + xml_text(mode.summary) + "</span>");
        std::string lines;
        for (const LimitationGroup& group : groups_of(mode.limitations))
            if (group.worst.severity != Severity::info) lines += element("li", xml_text(line_of(group)));
        if (!lines.empty()) html += element("ul class=\"quiet\"", lines);
        for (const ChartPoint& point : chart.points) {
            if (point.mode != mode.name) continue;
            const PointFiles files = files_of(point);
            const std::filesystem::path& directory = chart.job.directory;
            html += "<div class=\"rung\" data-of=\"" + point_name(point) + "\">" +
                    image(directory / files.small_picture, point_words(point)) +
                    image(directory / files.small_errors, "error of " + point_words(point)) + point_words(point) +
                    ": " + percent_label(point.errors.error) + ", " + seconds_label(point.seconds_1) + "</div>\n";
        }
    }
    return html;
}

// --- words -----------------------------------------------------------------------------------------------------------
std::string summary(const Chart& chart) {
    return "Frame " + std::to_string(chart.job.frame) + ", camera " + xml_text(chart.camera) + ", " +
           size_words(chart.size) + " pixels, " + std::to_string(chart.threads) + " threads, " + xml_text(chart.isa) +
           formatted(". Machine load: %.1f before, %.1f after. All modes render single scattering.", chart.load_before,
                     chart.load_after);
}

std::string reference_words(const ReferenceSamples& reference) {
    if (reference.count > 0) return std::to_string(reference.count / 2) + " rays per pixel each";
    return "as many rays as a noise of " + percent_label(reference.noise) + " needs, but at most " +
           seconds_label(reference.seconds) + " each";
}

std::string method(const Chart& chart) {
    const ChartJob& job = chart.job;
    std::vector<std::string> lines{
        "Reference: <code>march</code> with exact shadows and light followed through the fog, two independent halves "
        "of " +
            reference_words(job.reference) + "; their noise (" + percent_label(chart.reference_noise) +
            " of the mean) is subtracted from the errors. FLIP still includes it: " +
            number_words(chart.reference_flip) + " between the halves.",
        "Error E: root of the mean squared difference / mean of the reference, of the image or of the light of its "
        "fog alone, whichever is larger. 100 % is an error as large as the mean.",
        "Times: wall clock, median of at least " + std::to_string(job.runs) +
            " runs. Set-up is the time the first frame needs beyond the next one, which reuses what does not "
            "move; what is built once from a scene's triangles counts as loading.",
        "Memory: the peak of a frame on top of the scene; memory the program had free before is not counted.",
        "Flicker: changes between frames that the reference does not have / its mean, over " +
            std::to_string(job.sequence) + " frames of " + size_words(chart.sequence_size) +
            " pixels at pixel centers" +
            (chart.moves ? "." : "; the scene has no more frames, so nothing moves in them.") +
            " Modes start each frame without history.",
        "Fog light at pixel centers: every ray of a pixel goes through its center, in the reference too. What remains "
        "is the technique's own error and noise.",
        "The artistic modes (<code>billboard</code>, <code>radial-blur</code>) do not promise correct light: they are "
        "shown as rendered, and again, dashed and hollow, with their fog light scaled by the best-fitting factor.",
        "<code>path</code> scatters light once here and is measured by the light of lamps and suns; ambient light, "
        "which it shadows and the reference does not, is excluded on both sides.",
        "The gray steps join the settings that no other beats in both time and error. Whiskers: the fastest and the "
        "slowest run; two standard deviations of the uncertainty from the reference's noise."};
    std::string list;
    for (const std::string& text : lines) list += element("li", text);
    return element("ul", list);
}
}

std::string chart_html(const Chart& chart) {
    const std::string title = "Error against time: " + xml_text(chart.job.render.scene_file.filename().string());
    std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + title +
                       "</title>\n<meta name=\"viewport\" content=\"width=device-width\">\n"
                       "<link rel=\"icon\" href=\"data:,\">\n<style>" +
                       std::string(chart_page_style) + std::string(chart_svg_style) + "</style></head><body>\n";
    html += element("h1", title) + element("p", summary(chart)) + chart_svg(chart, FrameTime::single, ErrorOf::worse);
    html += element("h2", "What to use when") + advice_table(chart) + skipped(chart);
    html += element("h2", "The technique alone") +
            element("p class=\"quiet\"",
                    "The light of the fog at pixel centers: edges of surfaces and lamps inside pixels, which need many "
                    "rays per pixel in every mode, do not count here.") +
            chart_svg(chart, FrameTime::single, ErrorOf::fog);
    html += element("h2", "In a sequence") + chart_svg(chart, FrameTime::sequence, ErrorOf::worse);
    html += element("h2", "Images and where they are wrong") +
            element("p class=\"quiet\"", "Below each image its error at every pixel, as a share of the mean: black "
                                         "0.1 % or less, white 1000 %.") +
            gallery(chart);
    html += element("h2", "All numbers") + number_table(chart);
    html += element("h2", "How it was measured") + method(chart);
    return html + "<div id=\"tip\" role=\"tooltip\" hidden></div>\n<script>" + std::string(chart_page_script) +
           "</script></body></html>\n";
}
}
