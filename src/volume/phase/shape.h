// Phase functions with more than one parameter: lobes or a table, built once and shared by all media that use them.
#pragma once
#include "volume/phase/lobe.h"
#include "volume/phase/table.h"

#include <vector>

namespace tyndall {
struct PhaseShape {
    std::vector<PhaseLobe> lobes; // weights sum to 1; if empty, the table is used
    PhaseTable table;
    float mean_cosine = 0;
    float narrowest = 0; // |g| of the narrowest lobe
};

PhaseShape shape_of(std::vector<PhaseLobe> lobes);
PhaseShape shape_of(PhaseTable table);

double sampled_cosine(const PhaseShape& shape, double u);  // as for a lobe
double cosine_cdf(const PhaseShape& shape, double cosine); // likewise

// A lower bound of the value, 1/sr; 0 if values may be 0.
double min_value(const PhaseShape& shape);

// Value in 1/sr, in the precision of T.
template<class T> T shape_value(const PhaseShape& shape, T cosine) {
    if (shape.lobes.empty()) return table_value(shape.table, cosine);
    T sum = 0;
    for (const PhaseLobe& lobe : shape.lobes) sum += lobe_value(lobe, cosine);
    return sum;
}
}
