// The table of techniques with one more row: what a technique needs beside its own files.
#include "modes/mode.h"
#include "modes/techniques.h"

#include <array>

namespace tyndall {
#define DECLARE(name) Mode name##_mode();
#define ROW_OF(name) name##_mode(),
TYNDALL_TECHNIQUES(DECLARE)
Mode mist_mode();

std::span<const Mode> modes() {
    static const std::array table{TYNDALL_TECHNIQUES(ROW_OF) mist_mode()};
    return table;
}
}
