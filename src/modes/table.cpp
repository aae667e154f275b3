// The table of techniques.
#include "modes/mode.h"
#include "modes/techniques.h"

#include <array>

namespace tyndall {
#define DECLARE(name) Mode name##_mode();
#define ROW_OF(name) name##_mode(),
TYNDALL_TECHNIQUES(DECLARE)

std::span<const Mode> modes() {
    static const std::array table{TYNDALL_TECHNIQUES(ROW_OF)};
    return table;
}
}
