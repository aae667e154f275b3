#include "base/gauss_legendre.h"

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

TEST(GaussLegendre, SumsPieces) {
    EXPECT_NEAR(integral([](double x) { return 10 * std::pow(x, 9); }, 0, 2, 1), 1024, 1e-9); // the last exact power
    EXPECT_NEAR(integral([](double x) { return std::exp(x); }, -1, 3, 4), std::exp(3) - std::exp(-1), 1e-9);
    EXPECT_NEAR(integral([](double x) { return std::abs(x); }, -1, 3, 4), 5, 1e-12); // a kink between two pieces
}
}
}
