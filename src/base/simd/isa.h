// Which instruction set the SIMD kernels use: the best the machine supports, or a requested one.
#pragma once
#include <string_view>

namespace tyndall {
// `name`: "auto", "avx2" or "avx512". Returns the name of the selected instruction set. Must not be called while
// kernels run. Throws Error (usage) for an unknown name or an instruction set this machine does not have.
std::string_view set_isa(std::string_view name);

// "avx512" or "avx2".
std::string_view isa_name();
}
