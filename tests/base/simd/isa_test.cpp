#include "base/error.h"
#include "base/simd/isa.h"
#include "support/expect.h"

#include <gtest/gtest.h>

namespace tyndall {
namespace {
TEST(Isa, ChosenByName) {
    const std::string best(set_isa("auto"));
    EXPECT_EQ(isa_name(), best);
    for (const char* name : {"avx2", "avx512"}) {
        try {
            EXPECT_EQ(set_isa(name), name);
            EXPECT_EQ(isa_name(), name);
        } catch (const Error& error) {
            EXPECT_EQ(error.code, ExitCode::usage);
            EXPECT_EQ(isa_name(), best) << "a refused choice changes nothing";
        }
    }
    EXPECT_EQ(set_isa("auto"), best);
}

TEST(Isa, UnknownNamesAreRefused) {
    for (const char* name : {"", "AVX2", "sse", "avx", "avx5120"})
        EXPECT_EQ(error_of([&] { set_isa(name); }).code, ExitCode::usage) << name;
}
}
}
