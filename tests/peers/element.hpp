// One quintic element as least squares: residuals whose squares add up to the functional by a quadrature rule, and their
// Jacobian over the element's unknowns, by hand and by ceres::Jet. As lean as one would write it for speed. Which elements
// share which unknowns, the curve knows.
//
//   P' = v t,  P'' = v^2 kappa + b t
//
// with the unknowns (v, b), or as in the thesis (m, alpha) with v = m^2, b = alpha m^2.
#pragma once

#include <cmath>

#include <ceres/jet.h>

#include "peer.hpp"

namespace peer {

constexpr int kMostPoints = 32;

template <int D, class T = double>
using Vec = std::array<T, D>;

template <int D, class T, class U>
auto dot(const Vec<D, T>& a, const Vec<D, U>& b) {
    auto sum = a[0] * b[0];
    for (int i = 1; i < D; ++i) sum += a[i] * b[i];
    return sum;
}

// Components of a cross product: one in the plane, three in space.
template <int D>
constexpr int kComponents = D == 2 ? 1 : 3;

template <int D, class T>
Vec<kComponents<D>, T> cross(const Vec<D, T>& a, const Vec<D, T>& b) {
    if constexpr (D == 2)
        return {a[0] * b[1] - a[1] * b[0]};
    else
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// The gradient of component c of a x b by a; by b it is the negative of the same with a.
template <int D>
inline Vec<D> by_first(int c, const Vec<D>& b) {
    if constexpr (D == 2)
        return {b[1], -b[0]};
    else
        return c == 0 ? Vec<D>{0, b[2], -b[1]} : c == 1 ? Vec<D>{-b[2], 0, b[0]} : Vec<D>{b[1], -b[0], 0};
}

// The rule with the first three derivatives of the blending functions, point by point innermost: compilers vectorise that.
struct Rule {
    int points;
    double root_weight[kMostPoints];
    double basis[3][6][kMostPoints];

    explicit Rule(const std::vector<Node>& nodes) : points(int(nodes.size())) {
        if (points > kMostPoints) throw std::runtime_error("the rule has too many points");
        static constexpr double kPolynomial[6][6] = {
            {1, 0, 0, -10, 15, -6},  {0, 1, 0, -6, 8, -3}, {0, 0, 0.5, -1.5, 1.5, -0.5},
            {0, 0, 0, 0.5, -1, 0.5}, {0, 0, 0, -4, 7, -3}, {0, 0, 0, 10, -15, 6},
        };
        for (int i = 0; i < points; ++i) {
            root_weight[i] = std::sqrt(nodes[i].weight);
            for (int order = 1; order <= 3; ++order)
                for (int a = 0; a < 6; ++a) {
                    double h = 0;
                    for (int power = 5; power >= order; --power) {
                        double c = kPolynomial[a][power];
                        for (int k = 0; k < order; ++k) c *= power - k;
                        h = h * nodes[i].t + c;
                    }
                    basis[order - 1][a][i] = h;
                }
        }
    }
};

// An end of an element. Unknowns are counted within the element; -1 is none.
template <int D>
struct End {
    Vec<D> point;
    std::array<Vec<D>, D> frame;  // tangent and normals that the tangent's unknowns are measured from
    Vec<D - 1> bend;              // curvature along the normals, where it is fixed
    int tangent, curvature, shape;
};

// The frame turned by the tangent's unknowns: in the plane by an angle, in space by half the stereographic coordinates of
// the rotation without twist.
template <int D, class T>
std::array<Vec<D, T>, D> turned(const std::array<Vec<D>, D>& frame, const T* x) {
    using std::cos;
    using std::sin;
    std::array<Vec<D, T>, D> r;
    if constexpr (D == 2) {
        const T c = cos(x[0]), s = sin(x[0]);
        r = {{{c, s}, {-s, c}}};
    } else {
        const T p = x[0] * 0.5, q = x[1] * 0.5;
        const T pp = p * p, qq = q * q, pq = p * q * -2.0, per = 1.0 / (1.0 + pp + qq);
        r = {{{(1.0 - pp - qq) * per, 2.0 * p * per, 2.0 * q * per},
              {-2.0 * p * per, (1.0 - pp + qq) * per, pq * per},
              {-2.0 * q * per, pq * per, (1.0 + pp - qq) * per}}};
    }
    std::array<Vec<D, T>, D> axes;
    for (int i = 0; i < D; ++i)
        for (int c = 0; c < D; ++c) {
            axes[i][c] = r[i][0] * frame[0][c];
            for (int j = 1; j < D; ++j) axes[i][c] += r[i][j] * frame[j][c];
        }
    return axes;
}

// The derivative of turned() by each of the tangent's unknowns.
template <int D>
std::array<std::array<Vec<D>, D>, D - 1> turning(const std::array<Vec<D>, D>& frame, const double* x) {
    std::array<std::array<Vec<D>, D>, D - 1> r;
    if constexpr (D == 2) {
        const double c = std::cos(x[0]), s = std::sin(x[0]);
        r[0] = {{{-s, c}, {-c, -s}}};
    } else {
        const double p = 0.5 * x[0], q = 0.5 * x[1], pp = p * p, qq = q * q, pq = -2 * p * q, per = 1 / (1 + pp + qq);
        const double a[3][3] = {{1 - pp - qq, 2 * p, 2 * q}, {-2 * p, 1 - pp + qq, pq}, {-2 * q, pq, 1 + pp - qq}};
        const double by[2][3][3] = {{{-2 * p, 2, 0}, {-2, -2 * p, -2 * q}, {0, -2 * q, 2 * p}},
                                    {{-2 * q, 0, 2}, {0, 2 * q, -2 * p}, {-2, -2 * p, -2 * q}}};
        for (int k = 0; k < 2; ++k)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    r[k][i][j] = 0.5 * per * (by[k][i][j] - a[i][j] * per * 2 * (k == 0 ? p : q));
    }
    auto out = r;
    for (int k = 0; k < D - 1; ++k)
        for (int i = 0; i < D; ++i)
            for (int c = 0; c < D; ++c) {
                out[k][i][c] = 0;
                for (int j = 0; j < D; ++j) out[k][i][c] += r[k][i][j] * frame[j][c];
            }
    return out;
}

// Where the Jacobian's column of an unknown goes; null where it is not wanted.
struct Column {
    double* at;
    int stride;
};

constexpr int kMostLocal = 18;

enum class Derivatives { by_hand, by_jets };

template <int D, bool Thesis>
struct Element {
    static constexpr int kEnd = 2 * D;  // the most unknowns of an end

    End<D> ends[2];
    int unknowns;
    bool bending;
    const Rule* rule;

    int residuals() const { return rule->points * kComponents<D>; }

    static double speed_of(const double* shape) { return Thesis ? shape[0] * shape[0] : shape[0]; }

    // A quintic that runs backwards at an end breaks its tangent.
    bool in_domain(const double* x) const {
        return Thesis || (x[ends[0].shape] > 0 && x[ends[1].shape] > 0);
    }

    bool evaluate(const double* x, double* residuals, const Column* columns, Derivatives how) const {
        if (!in_domain(x)) return false;
        if (!columns) return sums<false>(x, residuals, nullptr);
        if (how == Derivatives::by_hand) return sums<true>(x, residuals, columns);
        switch (unknowns) {
            case 4: return jets<4>(x, residuals, columns);
            case 5: return jets<5>(x, residuals, columns);
            case 6: return jets<6>(x, residuals, columns);
            case 7: return jets<7>(x, residuals, columns);
            case 8: return jets<8>(x, residuals, columns);
            case 10: return jets<10>(x, residuals, columns);
            case 12: return jets<12>(x, residuals, columns);
            default: throw std::runtime_error("no jets of the element's number of unknowns were compiled");
        }
    }

    template <class T>
    std::array<Vec<D, T>, 6> rows(const T* x) const {
        std::array<Vec<D, T>, 6> rows;
        for (int e = 0; e < 2; ++e) {
            const End<D>& end = ends[e];
            std::array<Vec<D, T>, D> axes;
            if (end.tangent >= 0) {
                axes = turned<D, T>(end.frame, x + end.tangent);
            } else {
                for (int i = 0; i < D; ++i)
                    for (int c = 0; c < D; ++c) axes[i][c] = T(end.frame[i][c]);
            }
            const T* shape = x + end.shape;
            const T speed = Thesis ? T(shape[0] * shape[0]) : shape[0], stretch = Thesis ? T(shape[1] * speed) : shape[1];
            const T square = speed * speed;
            for (int c = 0; c < D; ++c) {
                T kappa = bend(end, x, 0) * axes[1][c];
                for (int i = 2; i < D; ++i) kappa += bend(end, x, i - 1) * axes[i][c];
                rows[e ? 5 : 0][c] = T(end.point[c]);
                rows[e ? 4 : 1][c] = speed * axes[0][c];
                rows[e ? 3 : 2][c] = square * kappa + stretch * axes[0][c];
            }
        }
        return rows;
    }

   private:
    template <class T>
    static T bend(const End<D>& end, const T* x, int i) {
        return end.curvature >= 0 ? x[end.curvature + i] : T(end.bend[i]);
    }

    // An unknown and how the end's rows C' and C'' follow it.
    struct Motion {
        int unknown;
        Vec<D> first, second;
    };

    int motions(const End<D>& end, const double* x, Motion* out) const {
        std::array<Vec<D>, D> axes = end.frame;
        if (end.tangent >= 0) axes = turned<D, double>(end.frame, x + end.tangent);
        const double* shape = x + end.shape;
        const double speed = speed_of(shape), stretch = Thesis ? shape[1] * speed : shape[1], square = speed * speed;
        int n = 0;
        if (end.tangent >= 0) {
            const auto by = turning<D>(end.frame, x + end.tangent);
            for (int k = 0; k < D - 1; ++k) {
                Motion& m = out[n++] = {end.tangent + k, {}, {}};
                for (int c = 0; c < D; ++c) {
                    double kappa = 0;
                    for (int i = 1; i < D; ++i) kappa += bend(end, x, i - 1) * by[k][i][c];
                    m.first[c] = speed * by[k][0][c];
                    m.second[c] = square * kappa + stretch * by[k][0][c];
                }
            }
        }
        if (end.curvature >= 0)
            for (int k = 0; k < D - 1; ++k) {
                Motion& m = out[n++] = {end.curvature + k, {}, {}};
                for (int c = 0; c < D; ++c) m.second[c] = square * axes[k + 1][c];
            }
        Motion& by_speed = out[n++] = {end.shape, axes[0], {}};
        Motion& by_stretch = out[n++] = {end.shape + 1, {}, axes[0]};
        for (int c = 0; c < D; ++c)
            for (int i = 1; i < D; ++i) by_speed.second[c] += 2 * speed * bend(end, x, i - 1) * axes[i][c];
        if (Thesis) {
            const double m = shape[0], alpha = shape[1];
            for (int c = 0; c < D; ++c) {
                by_speed.first[c] *= 2 * m;
                by_speed.second[c] = 2 * m * by_speed.second[c] + 2 * m * alpha * axes[0][c];
                by_stretch.second[c] *= m * m;
            }
        }
        return n;
    }

    // The residual's denominator: |C'|^(11/2) or |C'|^(5/2) with p = |C'|^2.
    template <class T>
    static T denominator(const T& p, bool bending) {
        using std::sqrt;
        const T root = sqrt(p), power = p * sqrt(root);
        return bending ? power : T(power * p * root);
    }

    template <bool WithJacobian>
    bool sums(const double* x, double* residuals, const Column* columns) const {
        return bending ? sums<WithJacobian, true>(x, residuals, columns) : sums<WithJacobian, false>(x, residuals, columns);
    }

    template <bool WithJacobian, bool Bending>
    bool sums(const double* x, double* residuals, const Column* columns) const {
        constexpr int C = kComponents<D>;
        const auto r = rows<double>(x);
        const Rule& at = *rule;
        const int points = at.points;
        // The gradient of each residual by C', C'' and C'''.
        double slope[C][3][D][kMostPoints];
        for (int i = 0; i < points; ++i) {
            Vec<D> d[3];
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < D; ++c)
                    d[k][c] = at.basis[k][0][i] * r[0][c] + at.basis[k][1][i] * r[1][c] + at.basis[k][2][i] * r[2][c] +
                              at.basis[k][3][i] * r[3][c] + at.basis[k][4][i] * r[4][c] + at.basis[k][5][i] * r[5][c];
            const double p = dot<D>(d[0], d[0]), q = dot<D>(d[0], d[1]);
            const double f = at.root_weight[i] / denominator(p, Bending);
            const auto u = cross<D>(d[0], d[1]), v = cross<D>(d[0], d[2]);
            for (int c = 0; c < C; ++c) {
                const double n = Bending ? u[c] : p * v[c] - 3 * q * u[c];
                const double residual = n * f;
                residuals[c * points + i] = residual;
                if constexpr (WithJacobian) {
                    const Vec<D> u1 = by_first<D>(c, d[1]), u2 = by_first<D>(c, d[0]);
                    const double down = (Bending ? 2.5 : 5.5) * residual / p;
                    if constexpr (Bending) {
                        for (int j = 0; j < D; ++j) {
                            slope[c][0][j][i] = f * u1[j] - down * d[0][j];
                            slope[c][1][j][i] = -f * u2[j];
                        }
                    } else {
                        const Vec<D> v1 = by_first<D>(c, d[2]);
                        for (int j = 0; j < D; ++j) {
                            const double by1 = 2 * d[0][j] * v[c] + p * v1[j] - 3 * (d[1][j] * u[c] + q * u1[j]);
                            slope[c][0][j][i] = f * by1 - down * d[0][j];
                            slope[c][1][j][i] = -3 * f * (d[0][j] * u[c] - q * u2[j]);
                            slope[c][2][j][i] = -f * p * u2[j];
                        }
                    }
                }
            }
        }
        if constexpr (WithJacobian) {
            constexpr int kOrders = Bending ? 2 : 3;
            for (int e = 0; e < 2; ++e) {
                Motion list[kEnd];
                const int count = motions(ends[e], x, list);
                const int first = e ? 4 : 1, second = e ? 3 : 2;
                for (int c = 0; c < C; ++c) {
                    double by_rows[2][D][kMostPoints];
                    for (int j = 0; j < D; ++j)
                        for (int i = 0; i < points; ++i) {
                            double one = 0, two = 0;
                            for (int k = 0; k < kOrders; ++k) {
                                one += slope[c][k][j][i] * at.basis[k][first][i];
                                two += slope[c][k][j][i] * at.basis[k][second][i];
                            }
                            by_rows[0][j][i] = one;
                            by_rows[1][j][i] = two;
                        }
                    for (int n = 0; n < count; ++n) {
                        const Motion& m = list[n];
                        const Column& column = columns[m.unknown];
                        if (!column.at) continue;
                        double* to = column.at + c * points * column.stride;
                        for (int i = 0; i < points; ++i) {
                            double sum = 0;
                            for (int j = 0; j < D; ++j)
                                sum += by_rows[0][j][i] * m.first[j] + by_rows[1][j][i] * m.second[j];
                            to[i * column.stride] = sum;
                        }
                    }
                }
            }
        }
        return true;
    }

    template <int N>
    bool jets(const double* x, double* residuals, const Column* columns) const {
        using T = ceres::Jet<double, N>;
        constexpr int C = kComponents<D>;
        T y[N];
        for (int k = 0; k < N; ++k) y[k] = T(x[k], k);
        const auto r = rows<T>(y);
        const Rule& at = *rule;
        for (int i = 0; i < at.points; ++i) {
            Vec<D, T> d[3];
            for (int k = 0; k < 3; ++k)
                for (int c = 0; c < D; ++c) {
                    d[k][c] = r[1][c] * at.basis[k][1][i];
                    for (int a = 2; a < 5; ++a) d[k][c] += r[a][c] * at.basis[k][a][i];
                    // Points are fixed.
                    d[k][c].a += ends[0].point[c] * at.basis[k][0][i] + ends[1].point[c] * at.basis[k][5][i];
                }
            const T p = dot<D>(d[0], d[0]), f = at.root_weight[i] / denominator(p, bending);
            const auto u = cross<D>(d[0], d[1]);
            Vec<C, T> n = u;
            if (!bending) {
                const T q = 3.0 * dot<D>(d[0], d[1]);
                const auto v = cross<D>(d[0], d[2]);
                for (int c = 0; c < C; ++c) n[c] = p * v[c] - q * u[c];
            }
            for (int c = 0; c < C; ++c) {
                const T residual = n[c] * f;
                const int row = c * at.points + i;
                residuals[row] = residual.a;
                for (int k = 0; k < N; ++k)
                    if (columns[k].at) columns[k].at[row * columns[k].stride] = residual.v[k];
            }
        }
        return true;
    }
};

}  // namespace peer
