#include "support/integral.h"

namespace tyndall::test {
double integral(const std::function<double(double)>& f, double a, double b, int pieces) {
    constexpr double x[] = {0, 0.5384693101056831, 0.9061798459386640},
                     w[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        const double half = 0.5 * (b - a) / pieces, middle = a + (2 * i + 1) * half;
        sum += half * w[0] * f(middle);
        for (int k = 1; k < 3; ++k) sum += half * w[k] * (f(middle - half * x[k]) + f(middle + half * x[k]));
    }
    return sum;
}
}
