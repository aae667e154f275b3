// A sample as part of a low-discrepancy sequence: each pixel and batch has its own.
#pragma once
#include <cstdint>

namespace tyndall {
struct SampleIndex {
    uint32_t sequence; // identifies the sequence
    uint32_t index;    // place in it
};
}
