#include "integrate/gauss_legendre.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tyndall {
namespace {
// Σ w x^p = 1/(p+1) on 0..1 for every power below twice the number of nodes.
TEST(GaussLegendre, IntegratesPolynomialsExactly) {
    for (const int count : {1, 2, 3, 4, 7, 16, 32}) {
        ASSERT_EQ(gauss_legendre(count).size(), static_cast<size_t>(count));
        for (int power = 0; power < 2 * count; ++power) {
            double sum = 0;
            for (const QuadratureNode& node : gauss_legendre(count)) sum += node.weight * std::pow(node.at, power);
            EXPECT_NEAR(sum * (power + 1), 1, 1e-12) << count << ' ' << power;
        }
    }
}
}
}
