// The programs are compiled for x86-64-v3 with AES and PCLMUL, this file for any x86-64 processor. On an older one it
// exits with a one-line error before an unsupported instruction can run.
#include <unistd.h>

namespace {
constexpr int unavailable = 69; // EX_UNAVAILABLE of sysexits.h
constexpr char line[] =
    "tyndall: error: this processor is too old: Tyndall needs x86-64-v3 (AVX2, FMA, BMI2, F16C) with "
    "AES and PCLMUL, as in Intel Haswell (2013), AMD Zen (2017) and later\n";

// Constructors with lower priority numbers run first.
__attribute__((constructor(101))) void refuse_old_processors() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v3") && __builtin_cpu_supports("aes") && __builtin_cpu_supports("pclmul"))
        return;
    const auto ignored = write(STDERR_FILENO, line, sizeof line - 1);
    (void)ignored;
    _exit(unavailable);
}
}
