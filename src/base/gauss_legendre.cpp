#include "base/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace tyndall {
namespace {
// Legendre polynomial P_n(x) and its derivative by the three-term recurrence.
void legendre(int n, double x, double& value, double& slope) {
    double before = 1;
    value = x;
    for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value, value = next;
    }
    slope = n * (x * value - before) / (x * x - 1);
}

// Roots by Newton's method from Tricomi's initial guess.
std::vector<QuadratureNode> rule(int n) {
    std::vector<QuadratureNode> nodes;
    for (int i = 0; i < n; ++i) {
        double x = n == 1 ? 0 : -std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), value = 0, slope = 1;
        for (int step = 0; n > 1 && step < 20; ++step) legendre(n, x, value, slope), x -= value / slope;
        if (n > 1) legendre(n, x, value, slope);
        const double weight = 1 / ((1 - x * x) * slope * slope);
        nodes.push_back({0.5 + 0.5 * x, weight});
    }
    return nodes;
}
}

std::span<const QuadratureNode> gauss_legendre(int count) {
    static const auto rules = [] {
        std::array<std::vector<QuadratureNode>, max_gauss_nodes + 1> all;
        for (int n = 1; n <= max_gauss_nodes; ++n) all[n] = rule(n);
        return all;
    }();
    return rules[std::clamp(count, 1, max_gauss_nodes)];
}

double integral(const std::function<double(double)>& f, double a, double b, int pieces) {
    const double length = (b - a) / pieces;
    double sum = 0;
    for (int piece = 0; piece < pieces; ++piece)
        for (const QuadratureNode& node : gauss_legendre(5)) sum += node.weight * f(a + (piece + node.at) * length);
    return sum * length;
}
}
