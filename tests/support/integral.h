// Quadrature to hold closed forms and methods against.
#pragma once
#include <functional>

namespace tyndall::test {
// ∫ f over a..b by composite Gauss–Legendre with 5 nodes on `pieces` pieces.
double integral(const std::function<double(double)>& f, double a, double b, int pieces = 4000);
}
