// Phase functions of more than one number: lobes or a table, made once and shared by all that scatter so.
#pragma once
#include "volume/phase/lobe.h"
#include "volume/phase/table.h"

#include <vector>

namespace tyndall {
struct PhaseShape {
    std::vector<PhaseLobe> lobes; // their weights add up to 1; none: it is the table
    PhaseTable table;
    float mean_cosine = 0;
    float narrowest = 0; // |g| of the narrowest lobe
};

PhaseShape shape_of(std::vector<PhaseLobe> lobes);
PhaseShape shape_of(PhaseTable table);

double sampled_cosine(const PhaseShape& shape, double u);   // as of a lobe
double share_below(const PhaseShape& shape, double cosine); // likewise

// A number that no value of it falls below, 1/sr; 0 where values may be 0.
double min_value(const PhaseShape& shape);

// Value in 1/sr, to the rounding of T.
template<class T> T shape_value(const PhaseShape& shape, T cosine) {
    if (shape.lobes.empty()) return table_value(shape.table, cosine);
    T sum = 0;
    for (const PhaseLobe& lobe : shape.lobes) sum += lobe_value(lobe, cosine);
    return sum;
}
}
