// One quintic Hermite element for any number type: rows from the thesis's parameters (4.7, 4.8), curvature and its
// arc-length derivative (4.7). Leaves to others which parameters are free.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <ceres/jet.h>

#include "quadrature.hpp"

namespace reference {

enum class Functional { mvc, mec, si_mvc };

// A constant of type T: ceres::Jet converts from its own scalar only, so nested jets need a ladder.
template <class T>
struct Constant {
    static T of(double x) { return T(x); }
};
template <class U, int N>
struct Constant<ceres::Jet<U, N>> {
    static ceres::Jet<U, N> of(double x) { return ceres::Jet<U, N>(Constant<U>::of(x)); }
};

// Multiplication by a plain number, which touches no cross terms.
template <class T>
T scaled(const T& a, long double b) {
    return a * T(b);
}
template <class U, int N>
ceres::Jet<U, N> scaled(const ceres::Jet<U, N>& a, long double b) {
    ceres::Jet<U, N> r;
    r.a = scaled(a.a, b);
    for (int i = 0; i < N; ++i) r.v[i] = scaled(a.v[i], b);
    return r;
}

template <int D, class T>
using Vec = std::array<T, D>;
template <int D, class T>
using Rows = std::array<Vec<D, T>, 6>;  // C(0), C'(0), C''(0), C''(1), C'(1), C(1)

template <int D, class T>
T dot(const Vec<D, T>& a, const Vec<D, T>& b) {
    T s = a[0] * b[0];
    for (int i = 1; i < D; ++i) s += a[i] * b[i];
    return s;
}

// The binormal form has one component in the plane, three in space.
template <int D>
constexpr int kBinormal = D == 2 ? 1 : 3;

template <int D, class T>
Vec<kBinormal<D>, T> cross(const Vec<D, T>& a, const Vec<D, T>& b) {
    if constexpr (D == 2)
        return {a[0] * b[1] - a[1] * b[0]};
    else
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Values of the six blending functions' k-th derivative at t.
inline std::array<long double, 6> blending(int k, long double t) {
    // Coefficients of 1, t, ..., t^5.
    static constexpr double kPolynomial[6][6] = {
        {1, 0, 0, -10, 15, -6}, {0, 1, 0, -6, 8, -3},     {0, 0, 0.5, -1.5, 1.5, -0.5},
        {0, 0, 0, 0.5, -1, 0.5}, {0, 0, 0, -4, 7, -3}, {0, 0, 0, 10, -15, 6},
    };
    std::array<long double, 6> h{};
    for (int i = 0; i < 6; ++i)
        for (int p = 5; p >= k; --p) {
            long double c = kPolynomial[i][p];
            for (int q = 0; q < k; ++q) c *= p - q;
            h[i] = h[i] * t + c;
        }
    return h;
}

struct Sample {
    long double weight;
    std::array<long double, 6> d1, d2, d3;
};

inline Sample sample_at(long double t, long double weight) {
    return {weight, blending(1, t), blending(2, t), blending(3, t)};
}

inline std::vector<Sample> samples(int points) {
    std::vector<Sample> s;
    for (const Node& node : gauss_legendre(points)) s.push_back(sample_at(node.t, node.weight));
    return s;
}

template <int D, class T>
Vec<D, T> combine(const Rows<D, T>& rows, const std::array<long double, 6>& h) {
    Vec<D, T> r;
    for (int c = 0; c < D; ++c) {
        r[c] = scaled(rows[0][c], h[0]);
        for (int i = 1; i < 6; ++i) r[c] += scaled(rows[i][c], h[i]);
    }
    return r;
}

template <int D, class T>
struct Bend {
    T speed;
    Vec<kBinormal<D>, T> kappa;     // u / v with u = C' x C'', v = |C'|^3
    Vec<kBinormal<D>, T> kappa_ds;  // (v u' - u v') / v^2 / |C'|; u' = C' x C''' (the thesis misprints C'' x C''')
};

template <int D, class T>
Bend<D, T> bend(const Rows<D, T>& rows, const Sample& at) {
    using std::sqrt;
    const Vec<D, T> d1 = combine<D, T>(rows, at.d1), d2 = combine<D, T>(rows, at.d2), d3 = combine<D, T>(rows, at.d3);
    const T square = dot<D, T>(d1, d1);
    Bend<D, T> r;
    r.speed = sqrt(square);
    const T v = square * r.speed;
    const T dv = scaled(r.speed * dot<D, T>(d1, d2), 3);
    const auto u = cross<D, T>(d1, d2), du = cross<D, T>(d1, d3);
    const T per_v = Constant<T>::of(1) / v;
    const T per_speed = Constant<T>::of(1) / r.speed;
    for (int c = 0; c < kBinormal<D>; ++c) {
        r.kappa[c] = u[c] * per_v;
        r.kappa_ds[c] = (du[c] - r.kappa[c] * dv) * per_v * per_speed;
    }
    return r;
}

template <class T>
struct Integrals {
    T V, E, L;
};

// With `only` the other of V and E is left at zero.
template <int D, class T>
Integrals<T> integrate(const Rows<D, T>& rows, const std::vector<Sample>& rule, bool want_v, bool want_e) {
    Integrals<T> sum{Constant<T>::of(0), Constant<T>::of(0), Constant<T>::of(0)};
    for (const Sample& at : rule) {
        const Bend<D, T> b = bend<D, T>(rows, at);
        const T ds = scaled(b.speed, at.weight);
        sum.L += ds;
        if (want_v) sum.V += dot<kBinormal<D>, T>(b.kappa_ds, b.kappa_ds) * ds;
        if (want_e) sum.E += dot<kBinormal<D>, T>(b.kappa, b.kappa) * ds;
    }
    return sum;
}

// An orthonormal frame that tangents are measured from: axis[0] a tangent, the others its normals (planar: axis[1] is to
// the left).
template <int D>
using Frame = std::array<Vec<D, double>, D>;

// The frame turned by the local tangent parameters. Planar: an angle. Space: half the stereographic coordinates of the minimal
// rotation (a quaternion with no part along the tangent), so d tangent / d parameter is a unit normal at zero.
template <int D, class T>
std::array<Vec<D, T>, D> turned(const Frame<D>& frame, const T* x) {
    using std::cos;
    using std::sin;
    std::array<std::array<T, D>, D> r;  // r[i][j]: component of new axis i along old axis j
    const T one = Constant<T>::of(1);
    if constexpr (D == 2) {
        const T c = cos(x[0]), s = sin(x[0]);
        r = {{{c, s}, {-s, c}}};
    } else {
        const T p = scaled(x[0], 0.5L), q = scaled(x[1], 0.5L);
        const T pp = p * p, qq = q * q, pq = scaled(p * q, -2);
        const T per = one / (one + pp + qq);
        r[0] = {(one - pp - qq) * per, scaled(p, 2) * per, scaled(q, 2) * per};
        r[1] = {scaled(p, -2) * per, (one - pp + qq) * per, pq * per};
        r[2] = {scaled(q, -2) * per, pq * per, (one + pp - qq) * per};
    }
    std::array<Vec<D, T>, D> axes;
    for (int i = 0; i < D; ++i)
        for (int c = 0; c < D; ++c) {
            axes[i][c] = scaled(r[i][0], frame[0][c]);
            for (int j = 1; j < D; ++j) axes[i][c] += scaled(r[i][j], frame[j][c]);
        }
    return axes;
}

// P' = m^2 t, P'' = m^4 kappa + alpha m^2 t, where kappa is the Frenet vector (towards the centre of curvature).
template <int D, class T>
void end_rows(const Frame<D>& frame, const T* tangent, const T* curvature, const T& m, const T& alpha, Vec<D, T>& first,
              Vec<D, T>& second) {
    const auto axes = turned<D, T>(frame, tangent);
    const T speed = m * m;
    for (int c = 0; c < D; ++c) {
        T kappa = curvature[0] * axes[1][c];
        for (int i = 2; i < D; ++i) kappa += curvature[i - 1] * axes[i][c];
        first[c] = speed * axes[0][c];
        second[c] = speed * (speed * kappa + alpha * axes[0][c]);
    }
}

// An element's parameters in order: point, tangent, curvature at 0; the same at 1; m0, m1, alpha0, alpha1. That is 6 D numbers.
template <int D>
constexpr int kLocal = 6 * D;

template <int D, class T>
Rows<D, T> element_rows(const Frame<D>& frame0, const Frame<D>& frame1, const T* p0, const T* t0, const T* k0, const T* p1,
                        const T* t1, const T* k1, const T* shape) {
    Rows<D, T> rows;
    for (int c = 0; c < D; ++c) {
        rows[0][c] = p0[c];
        rows[5][c] = p1[c];
    }
    end_rows<D, T>(frame0, t0, k0, shape[0], shape[2], rows[1], rows[2]);
    end_rows<D, T>(frame1, t1, k1, shape[1], shape[3], rows[4], rows[3]);
    return rows;
}

}  // namespace reference
