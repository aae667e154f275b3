// Settings of billboard: rows, and the ladder from fastest to most accurate.
#include "modes/billboard/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_billboard_rows(std::vector<SettingRow>& rows) {
    const auto number = [&](const char* name, const char* unit, double low, double high, const char* doc, auto field) {
        rows.push_back(number_row(std::string("billboard.") + name, unit, low, high, doc, field));
    };
    number("cards", "", 0, 256,
           "maximum number of cards found per light, largest openings first; 0 = only hand-placed cards",
           TYNDALL_FIELD(of<BillboardSettings>().cards));
    rows.push_back(choice_row("billboard.facing", {"axis", "camera", "cross"},
                              "how cards face the camera: axis = turned about their beam, camera = parallel to the "
                              "image plane, cross = two fixed, crossed cards per beam",
                              TYNDALL_FIELD(of<BillboardSettings>().facing)));
    number("brightness", "", 0, 1000, "factor on all cards and veils",
           TYNDALL_FIELD(of<BillboardSettings>().brightness));
    number("veil", "", 0, 1,
           "fraction of a sun's unshadowed fog light added as haze in the open, in addition to its cards",
           TYNDALL_FIELD(of<BillboardSettings>().veil));
    number("gaps", "", 0, 1000, "factor on cards found at gaps in the open, so that they show against the veil",
           TYNDALL_FIELD(of<BillboardSettings>().gaps));
    number("streaks", "", 0, 1, "how much stripes along the beam darken it",
           TYNDALL_FIELD(of<BillboardSettings>().streaks));
    number("stripes", "", 0, 200, "stripes across a card", TYNDALL_FIELD(of<BillboardSettings>().stripes));
    number("soft", "", 0.05, 1, "fraction of a card's half width over which it fades out",
           TYNDALL_FIELD(of<BillboardSettings>().soft));
    number("scroll", "m/s", -1e9, 1e9, "how fast the texture moves along the beam",
           TYNDALL_FIELD(of<BillboardSettings>().scroll));
    number("sway", "", 0, 1, "how much a card's brightness varies over time",
           TYNDALL_FIELD(of<BillboardSettings>().sway));
    number("specks", "", 0, 100, "brightness of dust particles in the beam",
           TYNDALL_FIELD(of<BillboardSettings>().specks));
    number("near_fade", "m", 0, 1e9, "distance from the camera within which cards fade in",
           TYNDALL_FIELD(of<BillboardSettings>().near_fade));
    number("far_fade", "m", 1e-6, 1e9,
           "distance from the camera at which cards have faded out, over the last half of it",
           TYNDALL_FIELD(of<BillboardSettings>().far_fade));
    number("soft_depth", "m", 0, 1e9, "distance in front of a surface over which a card fades out",
           TYNDALL_FIELD(of<BillboardSettings>().soft_depth));
    rows.push_back(choice_row("billboard.fog", switches, "homogeneous fog dims the cards and what is behind them",
                              TYNDALL_FIELD(of<BillboardSettings>().fog)));
    mark_advanced(rows, {"veil", "gaps", "streaks", "stripes", "soft", "scroll", "sway", "specks", "near_fade",
                         "far_fade", "soft_depth"});
}

std::vector<Rung> billboard_rungs() {
    return {{"", "pixel.samples=1 billboard.cards=8"},    {"", "pixel.samples=1 billboard.cards=16"},
            {"", "pixel.samples=1 billboard.cards=64"},   {"", "pixel.samples=4 billboard.cards=64"},
            {"", "pixel.samples=16 billboard.cards=128"}, {"", "pixel.samples=64 billboard.cards=256"}};
}
}
