// Gauss–Legendre quadrature on 0..1.
#pragma once
#include <span>

namespace tyndall {
struct QuadratureNode {
    double at, weight;
};
inline constexpr int most_gauss_nodes = 32;

// The rule with `count` nodes, 1..32, exact for polynomials of degree 2·count - 1.
std::span<const QuadratureNode> gauss_legendre(int count);
}
