// Gauss–Legendre quadrature on 0..1.
#pragma once
#include <functional>
#include <span>

namespace tyndall {
struct QuadratureNode {
    double at, weight;
};
inline constexpr int max_gauss_nodes = 32;

// The rule with `count` nodes, 1..32, exact for polynomials of degree 2·count - 1.
std::span<const QuadratureNode> gauss_legendre(int count);

// ∫ f over a..b by the 5-node rule on each of `pieces` equal subintervals.
double integral(const std::function<double(double)>& f, double a, double b, int pieces = 4000);
}
