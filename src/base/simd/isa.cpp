#include "base/simd/isa.h"

#include "base/error.h"
#include "base/text.h"

#include <hwy/targets.h>

#include <string>

namespace tyndall {
std::string_view isa_name() { return hwy::SupportedTargets() & HWY_AVX3 ? "avx512" : "avx2"; }

std::string_view set_isa(std::string_view name) {
    choice_among("--isa", name, {"auto", "avx2", "avx512"});
    // Zero clears any earlier choice, so that SupportedTargets() reports what the machine supports.
    hwy::SetSupportedTargetsForTest(0);
    if (name != "auto") {
        const int64_t target = name == "avx2" ? HWY_AVX2 : HWY_AVX3;
        if (!(hwy::SupportedTargets() & target))
            fail(ExitCode::usage, "--isa", "this machine does not support " + std::string(name));
        hwy::SetSupportedTargetsForTest(target);
    }
    return isa_name();
}
}
