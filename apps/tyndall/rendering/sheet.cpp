#include "rendering/sheet.h"

#include "base/error.h"
#include "base/io/frames.h"
#include "base/text.h"
#include "measure/chart/report.h"
#include "measure/metrics/comparison.h"
#include "render/image/contact_sheet.h"

namespace tyndall {
void check_sheet_reference(const std::string& pattern, std::span<const int> frames, ivec2 size) {
    std::string last;
    for (const int frame : frames) {
        const std::string file = frame_name(pattern, frame);
        if (file == last) return; // one for all frames
        last = file;
        const ivec2 display = read_exr_colors(file).display;
        if (display != size)
            refuse(file,
                   formatted("has %d x %d pixels; the frames will have %d x %d", display.x, display.y, size.x, size.y));
    }
}

void write_sheet(const std::filesystem::path& sheet, const std::vector<SheetEntry>& entries, const std::string& pattern,
                 int frame, const Display& display) {
    std::optional<ExrColors> reference;
    if (!pattern.empty()) reference = read_exr_colors(frame_name(pattern, frame));
    std::vector<SheetImage> pictures;
    for (const SheetEntry& entry : entries) {
        ExrColors picture = read_exr_colors(entry.file);
        std::vector<std::string> lines{entry.mode, entry.times};
        if (reference) {
            check_same_frame(picture, *reference);
            const Comparison found = compare(picture, *reference, viewing_of(reference->beauty));
            lines.push_back("error " + percent_label(found.worst_rmse()) + formatted(", FLIP %.3f", found.flip));
        }
        pictures.push_back({std::move(picture.beauty), std::move(lines)});
    }
    if (reference) pictures.push_back({std::move(reference->beauty), {"reference"}});
    write_contact_sheet(sheet, pictures, display);
}
}
