// A curve as unknowns: which points, tangents and curvatures elements share, which are free, and the functional with its exact
// gradient and Hessian over them. Leaves minimising to others.
#pragma once

#include <algorithm>
#include <limits>

#include <Eigen/Dense>

#include "start.hpp"

namespace reference {

template <int D>
struct Point {
    std::array<double, D> x;
    bool fixed;
};

template <int D>
struct Tangent {
    Frame<D> frame;
    std::array<double, D - 1> x{};  // see turned()
    bool fixed;
    bool anchored;  // a fixed curvature is measured from this frame: it must not move
};

template <int D>
struct Curvature {
    std::array<double, D - 1> x;  // components along the turned frame's normals
    bool fixed;
};

struct Element {
    size_t point[2], tangent[2], curvature[2];
    double shape[4];  // m0, m1, alpha0, alpha1
};

// A normal frame; planar with the left normal, in space with the first normal along `towards` where that is possible.
template <int D>
Frame<D> frame_of(const V3& t, const V3& towards) {
    if constexpr (D == 2) {
        (void)towards;
        return {{{t[0], t[1]}, {-t[1], t[0]}}};
    } else {
        V3 n = normal_part(towards, t);
        if (!(size(n) > 1e-6 * size(towards))) {
            V3 axis{};
            axis[std::fabs(t[0]) < 0.6 ? 0 : std::fabs(t[1]) < 0.6 ? 1 : 2] = 1;
            n = normal_part(axis, t);
        }
        n = unit(n);
        return {t, n, outer(t, n)};
    }
}

template <int D>
class Model {
   public:
    std::vector<Point<D>> points;
    std::vector<Tangent<D>> tangents;
    std::vector<Curvature<D>> curvatures;
    std::vector<Element> elements;
    Functional functional;
    double unit_length;  // the joints' mean distance, shared among a span's elements: the scale of the parameters
    std::vector<Sample> rule;

    // The parameters nearest to given rows; fixed ones come from the problem.
    Model(const reference_problem& problem, const std::vector<Rows<3, double>>& rows)
        : functional(problem.functional == REFERENCE_MVC   ? Functional::mvc
                     : problem.functional == REFERENCE_MEC ? Functional::mec
                                                           : Functional::si_mvc),
          rule(samples(problem.points)) {
        const size_t spans = span_count(problem), pieces = problem.elements_per_span, count = spans * pieces;
        if (problem.closed && count < 2) throw std::invalid_argument("a closed curve needs two elements or more");
        const auto start = start_joints(problem);
        const size_t vertices = problem.closed ? count : count + 1;
        elements.resize(count);
        double chords = 0;
        for (size_t v = 0; v < vertices; ++v) {
            const bool before = problem.closed || v > 0, after = problem.closed || v < count;
            const size_t in = (v + count - 1) % count, out = v % count;
            const reference_joint* joint = v % pieces == 0 ? &problem.joints[v / pieces] : nullptr;
            const JointStart* given = joint ? &start[v / pieces] : nullptr;
            const int continuity = joint && before && after ? joint->continuity : 2;

            const V3 place = !after ? rows[in][5] : !before ? rows[out][0] : times(sum(rows[in][5], rows[out][0]), 0.5);
            const bool fixed = joint && joint->position_status == REFERENCE_FIXED;
            const V3 p = fixed ? v3(joint->position) : place;
            points.push_back({{}, fixed});
            for (int c = 0; c < D; ++c) points.back().x[c] = p[c];

            const bool tangent_fixed = joint && joint->tangent_status == REFERENCE_FIXED;
            const bool curvature_fixed = joint && joint->curvature_status == REFERENCE_FIXED;
            const V3 t_in = before ? rows[in][4] : V3{}, t_out = after ? rows[out][1] : V3{};
            const V3 k_in = before ? frenet(rows[in][4], rows[in][3]) : V3{};
            const V3 k_out = after ? frenet(rows[out][1], rows[out][2]) : V3{};
            const auto add_tangent = [&](const V3& direction) {
                const bool anchored = curvature_fixed && !tangent_fixed;
                const V3 t = tangent_fixed || anchored ? given->out.tangent : direction;
                Tangent<D> tangent{frame_of<D>(t, sum(k_in, k_out)), {}, tangent_fixed, anchored};
                if (anchored) {
                    tangent.frame = frame_of<D>(t, given->out.curvature);
                    aim(tangent, direction);
                }
                tangents.push_back(tangent);
                return tangents.size() - 1;
            };
            const auto add_curvature = [&](size_t tangent, const V3& k) {
                const auto axes = turned<D, double>(tangents[tangent].frame, tangents[tangent].x.data());
                Curvature<D> curvature{{}, curvature_fixed};
                for (int i = 1; i < D; ++i)
                    for (int c = 0; c < D; ++c)
                        curvature.x[i - 1] += curvature_fixed ? tangents[tangent].frame[i][c] * given->out.curvature[c]
                                                              : axes[i][c] * k[c];
                curvatures.push_back(curvature);
                return curvatures.size() - 1;
            };
            const auto mean = [&](const V3& a, const V3& b) { return times(sum(a, b), before && after ? 0.5 : 1.0); };
            const auto directed = [](const V3& t) { return size(t) > 0 ? unit(t) : t; };
            size_t tin, tout, kin, kout;
            if (continuity == 0) {
                tin = add_tangent(directed(t_in));
                tout = add_tangent(directed(t_out));
            } else {
                tin = tout = add_tangent(directed(sum(directed(t_in), directed(t_out))));
            }
            if (continuity < 2) {
                kin = add_curvature(tin, k_in);
                kout = add_curvature(tout, k_out);
            } else {
                kin = kout = add_curvature(tin, mean(k_in, k_out));
            }
            if (before) {
                elements[in].point[1] = v, elements[in].tangent[1] = tin, elements[in].curvature[1] = kin;
                set_shape(elements[in], 1, rows[in][4], rows[in][3]);
            }
            if (after) {
                elements[out].point[0] = v, elements[out].tangent[0] = tout, elements[out].curvature[0] = kout;
                set_shape(elements[out], 0, rows[out][1], rows[out][2]);
            }
        }
        for (size_t s = 0; s < spans; ++s)
            chords += size(sum(v3(problem.joints[(s + 1) % problem.joint_count].position),
                               v3(problem.joints[s].position), -1));
        unit_length = chords / count;
        index();
    }

    size_t parameter_count() const { return free.size(); }
    // One natural unit of each free parameter.
    Eigen::VectorXd scale() const {
        Eigen::VectorXd s(free.size());
        for (size_t i = 0; i < free.size(); ++i) s[i] = scales[i];
        return s;
    }
    Eigen::VectorXd get() const {
        Eigen::VectorXd x(free.size());
        for (size_t i = 0; i < free.size(); ++i) x[i] = *at(free[i]);
        return x;
    }
    void set(const Eigen::VectorXd& x) {
        for (size_t i = 0; i < free.size(); ++i) *at(free[i]) = x[i];
    }

    // Whether an element has grown out of all proportion, towards a minimum at infinity.
    bool runaway() const {
        for (const Element& e : elements)
            if (!(std::max(std::fabs(e.shape[0]), std::fabs(e.shape[1])) < 100 * std::sqrt(unit_length))) return true;
        return false;
    }

    // The functional of a bend of one radian an element.
    double natural_value() const {
        const double n = double(elements.size());
        switch (functional) {
            case Functional::mec: return n / unit_length;
            case Functional::mvc: return n / (unit_length * unit_length * unit_length);
            default: return n * n * n * n;
        }
    }

    // Starts the tangent parameters anew at zero, where they are unit normals.
    void recentre() {
        for (Tangent<D>& t : tangents)
            if (!t.anchored) {
                t.frame = turned<D, double>(t.frame, t.x.data());
                t.x = {};
            }
    }

    Rows<D, double> rows(size_t e) const {
        const Element& el = elements[e];
        return element_rows<D, double>(tangents[el.tangent[0]].frame, tangents[el.tangent[1]].frame,
                                       points[el.point[0]].x.data(), tangents[el.tangent[0]].x.data(),
                                       curvatures[el.curvature[0]].x.data(), points[el.point[1]].x.data(),
                                       tangents[el.tangent[1]].x.data(), curvatures[el.curvature[1]].x.data(), el.shape);
    }

    double value() const {
        double f = 0, length = 0;
        for (size_t e = 0; e < elements.size(); ++e) {
            const auto sums = element_sums<double>(e);
            f += sums[0];
            length += sums[1];
        }
        return functional == Functional::si_mvc ? length * length * length * f : f;
    }

    double gradient(Eigen::VectorXd& g) const {
        const size_t n = free.size();
        Eigen::VectorXd g_length = Eigen::VectorXd::Zero(n);
        g = Eigen::VectorXd::Zero(n);
        double f = 0, length = 0;
        for (size_t e = 0; e < elements.size(); ++e) {
            const auto sums = element_sums<ceres::Jet<double, kLocal<D>>>(e);
            f += sums[0].a;
            length += sums[1].a;
            for (int i = 0; i < kLocal<D>; ++i)
                if (local[e][i] >= 0) {
                    g[local[e][i]] += sums[0].v[i];
                    g_length[local[e][i]] += sums[1].v[i];
                }
        }
        if (functional != Functional::si_mvc) return f;
        const double l3 = length * length * length;
        g = l3 * g + 3 * length * length * f * g_length;
        return l3 * f;
    }

    double hessian(Eigen::VectorXd& g, Eigen::MatrixXd& h) const {
        using Inner = ceres::Jet<double, kLocal<D>>;
        using Outer = ceres::Jet<Inner, kLocal<D>>;
        const size_t n = free.size();
        Eigen::VectorXd g_length = Eigen::VectorXd::Zero(n);
        Eigen::MatrixXd h_length = Eigen::MatrixXd::Zero(n, n);
        g = Eigen::VectorXd::Zero(n);
        h = Eigen::MatrixXd::Zero(n, n);
        double f = 0, length = 0;
        for (size_t e = 0; e < elements.size(); ++e) {
            const auto sums = element_sums<Outer>(e);
            f += sums[0].a.a;
            length += sums[1].a.a;
            for (int i = 0; i < kLocal<D>; ++i) {
                const int row = local[e][i];
                if (row < 0) continue;
                g[row] += sums[0].a.v[i];
                g_length[row] += sums[1].a.v[i];
                for (int j = 0; j < kLocal<D>; ++j) {
                    const int column = local[e][j];
                    if (column < 0) continue;
                    h(row, column) += sums[0].v[i].v[j];
                    h_length(row, column) += sums[1].v[i].v[j];
                }
            }
        }
        if (functional == Functional::si_mvc) {
            const double l2 = length * length, l3 = l2 * length;
            h = (l3 * h + 3 * l2 * (g_length * g.transpose() + g * g_length.transpose()) +
                 f * (6 * length * g_length * g_length.transpose() + 3 * l2 * h_length))
                    .eval();
            g = (l3 * g + 3 * l2 * f * g_length).eval();
            f *= l3;
        }
        h = (0.5 * (h + h.transpose())).eval();
        return f;
    }

   private:
    // Where a scalar lives, so that a copied model stays whole.
    struct Place {
        enum { point, tangent, curvature, shape } kind;
        size_t block;
        int component;
    };
    std::vector<Place> free;
    std::vector<double> scales;
    std::vector<std::array<int, kLocal<D>>> local;  // of each element: the free index of each local parameter, or -1

    double* at(const Place& p) {
        switch (p.kind) {
            case Place::point: return &points[p.block].x[p.component];
            case Place::tangent: return &tangents[p.block].x[p.component];
            case Place::curvature: return &curvatures[p.block].x[p.component];
            default: return &elements[p.block].shape[p.component];
        }
    }
    const double* at(const Place& p) const { return const_cast<Model*>(this)->at(p); }

    static V3 frenet(const V3& first, const V3& second) {
        const double speed = size(first);
        if (!(speed > 0)) throw std::invalid_argument("a start element stands still at its end");
        return times(normal_part(second, unit(first)), 1 / (speed * speed));
    }

    static void set_shape(Element& element, int end, const V3& first, const V3& second) {
        const double speed = size(first);
        element.shape[end] = std::sqrt(speed);
        element.shape[2 + end] = inner(second, first) / (speed * speed);
    }

    // Tangent parameters that turn the frame's tangent into `direction`: the inverse of turned().
    static void aim(Tangent<D>& tangent, const V3& direction) {
        std::array<double, D> c{};
        for (int i = 0; i < D; ++i)
            for (int j = 0; j < D; ++j) c[i] += tangent.frame[i][j] * direction[j];
        if constexpr (D == 2) {
            tangent.x[0] = std::atan2(c[1], c[0]);
        } else {
            for (int i = 1; i < D; ++i) tangent.x[i - 1] = 2 * c[i] / std::max(1 + c[0], 1e-6);
        }
    }

    void index() {
        std::vector<int> point_at, tangent_at, curvature_at;
        const auto add = [&](decltype(Place::kind) kind, size_t block, int components, bool fixed, double unit) {
            if (fixed) return -1;
            const int first = int(free.size());
            for (int c = 0; c < components; ++c) {
                free.push_back({kind, block, c});
                scales.push_back(unit);
            }
            return first;
        };
        for (size_t i = 0; i < points.size(); ++i) point_at.push_back(add(Place::point, i, D, points[i].fixed, unit_length));
        for (size_t i = 0; i < tangents.size(); ++i) tangent_at.push_back(add(Place::tangent, i, D - 1, tangents[i].fixed, 1));
        for (size_t i = 0; i < curvatures.size(); ++i)
            curvature_at.push_back(add(Place::curvature, i, D - 1, curvatures[i].fixed, 1 / unit_length));
        for (size_t e = 0; e < elements.size(); ++e) {
            const int shape = add(Place::shape, e, 4, false, 1);
            scales[shape] = scales[shape + 1] = std::sqrt(unit_length);
            std::array<int, kLocal<D>> l;
            int k = 0;
            const auto put = [&](int first, int components) {
                for (int c = 0; c < components; ++c) l[k++] = first < 0 ? -1 : first + c;
            };
            for (int end = 0; end < 2; ++end) {
                put(point_at[elements[e].point[end]], D);
                put(tangent_at[elements[e].tangent[end]], D - 1);
                put(curvature_at[elements[e].curvature[end]], D - 1);
            }
            put(shape, 4);
            local.push_back(l);
        }
    }

    static double seeded(double x, int, double*) { return x; }
    template <class U, int N>
    static ceres::Jet<U, N> seeded(double x, int i, ceres::Jet<U, N>*) {
        ceres::Jet<U, N> r(seeded(x, i, static_cast<U*>(nullptr)));
        r.v[i] = Constant<U>::of(1);
        return r;
    }

    // The functional's integrand (V for the scale-invariant form) and the length of one element.
    template <class T>
    std::array<T, 2> element_sums(size_t e) const {
        const Element& el = elements[e];
        T x[kLocal<D>];
        int k = 0;
        const auto put = [&](const double* values, int n) {
            for (int c = 0; c < n; ++c, ++k) x[k] = seeded(values[c], k, static_cast<T*>(nullptr));
        };
        for (int end = 0; end < 2; ++end) {
            put(points[el.point[end]].x.data(), D);
            put(tangents[el.tangent[end]].x.data(), D - 1);
            put(curvatures[el.curvature[end]].x.data(), D - 1);
        }
        put(el.shape, 4);
        constexpr int kSide = 3 * D - 2;
        const auto r = element_rows<D, T>(tangents[el.tangent[0]].frame, tangents[el.tangent[1]].frame, x, x + D,
                                          x + 2 * D - 1, x + kSide, x + kSide + D, x + kSide + 2 * D - 1, x + 2 * kSide);
        const bool bending = functional == Functional::mec;
        const auto sums = integrate<D, T>(r, rule, !bending, bending);
        return {bending ? sums.E : sums.V, sums.L};
    }
};

}  // namespace reference
