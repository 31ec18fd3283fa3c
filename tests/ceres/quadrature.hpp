// Gauss-Legendre rules of any size on [0, 1]. Knows nothing of curves.
#pragma once

#include <cmath>
#include <vector>

namespace reference {

struct Node {
    long double t, weight;
};

// Newton on the three-term recurrence of P_n; the weight is 2 / ((1 - x^2) P_n'(x)^2), halved for [0, 1].
inline std::vector<Node> gauss_legendre(int n) {
    const long double pi = std::acos(-1.0L);
    std::vector<Node> nodes(n);
    for (int i = 0; i < n; ++i) {
        long double x = -std::cos(pi * (i + 0.75L) / (n + 0.5L));
        long double slope = 0;
        for (int step = 0; step < 50; ++step) {
            long double p = 1, before = 0;
            for (int k = 1; k <= n; ++k) {
                const long double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = n * (before - x * p) / (1 - x * x);
            const long double change = p / slope;
            x -= change;
            if (std::fabs(change) < 1e-19L) break;
        }
        nodes[i] = {(1 + x) / 2, 1 / ((1 - x * x) * slope * slope)};
    }
    return nodes;
}

}  // namespace reference
