// Programs are compiled for x86-64-v3 with AES and PCLMUL. This file is compiled for any x86-64 processor and ends them
// on an older one with one line, before code that the processor lacks can run.
#include <unistd.h>

namespace {
constexpr int unavailable = 69; // EX_UNAVAILABLE of sysexits.h
constexpr char line[] =
    "tyndall: error: this processor is too old: Tyndall needs x86-64-v3 (AVX2, FMA, BMI2, F16C) with "
    "AES and PCLMUL, as in Intel Haswell (2013), AMD Zen (2017) and later\n";

// Constructors of the lowest number run first.
__attribute__((constructor(101))) void refuse_old_processors() {
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v3") && __builtin_cpu_supports("aes") && __builtin_cpu_supports("pclmul"))
        return;
    const auto ignored = write(STDERR_FILENO, line, sizeof line - 1);
    (void)ignored;
    _exit(unavailable);
}
}
