// A curve of a case as unknowns in one row of numbers: node, element, node, element, ... A node is a joint, and holds what is
// free there and shared by the elements that meet; an element holds its four scalars and what its ends do not share.
#pragma once

#include <cmath>

#include "element.hpp"

namespace peer {

template <int D>
Vec<D> narrow(const Vector& v) {
    Vec<D> r;
    for (int c = 0; c < D; ++c) r[c] = v[c];
    return r;
}

template <int D>
Vec<D> unit(Vec<D> v) {
    const double size = std::sqrt(dot<D>(v, v));
    for (double& c : v) c /= size;
    return v;
}

// A tangent with its normals: in the plane the left one, in space the first along `towards`, where that is possible.
template <int D>
std::array<Vec<D>, D> frame_of(const Vec<D>& t, Vec<D> towards) {
    if constexpr (D == 2) {
        return {t, {-t[1], t[0]}};
    } else {
        const auto across = [&](Vec<D> v) {
            const double along = dot<D>(v, t);
            for (int c = 0; c < D; ++c) v[c] -= along * t[c];
            return v;
        };
        Vec<D> normal = across(towards);
        if (!(dot<D>(normal, normal) > 1e-12 * dot<D>(towards, towards))) {
            Vec<D> axis{};
            axis[std::fabs(t[0]) < 0.6 ? 0 : std::fabs(t[1]) < 0.6 ? 1 : 2] = 1;
            normal = across(axis);
        }
        normal = unit<D>(normal);
        return {t, normal, cross<D>(t, normal)};
    }
}

// A run of unknowns: a parameter block.
struct Block {
    int begin, size;
};

template <int D, bool Thesis>
class Curve {
   public:
    struct Part {
        Element<D, Thesis> element;
        Block blocks[3];               // node, element, node; the nodes' may be empty
        std::array<int, kMostLocal> global;  // the unknown of the curve that each of the element's is
    };

    // The start as unknowns.
    std::vector<double> start;
    std::vector<Block> blocks;
    std::vector<Part> parts;

    explicit Curve(const Case& data) : rule_(data.rule) {
        const size_t spans = data.spans(), joints = data.joints.size();
        if (data.start.size() != spans) throw std::runtime_error("one element a span, no more");
        // The unknowns of the shared tangent and curvature at each joint.
        std::vector<Shared> shared(joints);
        std::vector<Block> elements(spans);
        const auto add = [&](int count) {
            const int begin = int(start.size());
            start.resize(begin + count);
            return begin;
        };
        for (size_t i = 0; i < joints; ++i) {
            const Joint& joint = data.joints[i];
            const bool inner = data.closed || (i > 0 && i + 1 < joints);
            Shared& s = shared[i];
            s.continuity = inner ? joint.continuity : 2;
            const Rows& rows = data.start[i < spans ? i : i - 1];
            const auto [first, second] = i < spans ? std::pair(rows[1], rows[2]) : std::pair(rows[4], rows[3]);
            s.frame = frame_of<D>(unit<D>(narrow<D>(first)), narrow<D>(second));
            s.block.begin = int(start.size());
            if (!joint.tangent.fixed && s.continuity > 0) s.tangent = add(D - 1);
            if (!joint.curvature.fixed && s.continuity > 1) s.curvature = add(D - 1);
            s.block.size = int(start.size()) - s.block.begin;
            if (D == 3 && joint.curvature.fixed && !joint.tangent.fixed)
                throw std::runtime_error("a fixed curvature that may turn about its tangent is not among the cases");
            if (i < spans) {
                elements[i] = {add(4), 0};
                // What this element does not share at its two ends.
                const size_t next = (i + 1) % joints;
                for (const size_t node : {i, next}) {
                    const bool within = data.closed || (node > 0 && node + 1 < joints);
                    if (!within) continue;
                    if (data.joints[node].continuity == 0) throw std::runtime_error("corners are not among the cases");
                    if (data.joints[node].continuity == 1 && !data.joints[node].curvature.fixed) add(D - 1);
                }
                elements[i].size = int(start.size()) - elements[i].begin;
            }
        }
        for (const Shared& s : shared)
            if (s.block.size > 0) blocks.push_back(s.block);
        blocks.insert(blocks.end(), elements.begin(), elements.end());

        parts.resize(spans);
        for (size_t i = 0; i < spans; ++i) {
            Part& part = parts[i];
            const Shared* nodes[2] = {&shared[i], &shared[(i + 1) % joints]};
            part.blocks[0] = nodes[0]->block;
            part.blocks[1] = elements[i];
            part.blocks[2] = nodes[1]->block;
            int local = 0;
            const int at[3] = {0, part.blocks[0].size, part.blocks[0].size + part.blocks[1].size};
            for (const Block& block : part.blocks)
                for (int k = 0; k < block.size; ++k) part.global[local++] = block.begin + k;
            part.element.unknowns = local;
            part.element.bending = data.bending;
            part.element.rule = &rule_;
            int own = at[1] + 4;
            for (int e = 0; e < 2; ++e) {
                const Shared& node = *nodes[e];
                const Joint& joint = data.joints[(i + e) % joints];
                const Rows& rows = data.start[i];
                End<D>& end = part.element.ends[e];
                const auto in_element = [&](int global) { return global < 0 ? -1 : global - node.block.begin + at[2 * e]; };
                end.point = narrow<D>(joint.point);
                end.frame = node.frame;
                end.tangent = in_element(node.tangent);
                end.curvature = in_element(node.curvature);
                if (node.continuity < 2 && !joint.curvature.fixed) {
                    end.curvature = own;
                    own += D - 1;
                }
                end.shape = at[1] + 2 * e;

                const Vec<D> first = narrow<D>(rows[e ? 4 : 1]), second = narrow<D>(rows[e ? 3 : 2]);
                const double square = dot<D>(first, first), speed = std::sqrt(square), along = dot<D>(first, second);
                double* shape = &start[part.global[end.shape]];
                shape[0] = Thesis ? std::sqrt(speed) : speed;
                shape[1] = Thesis ? along / square : along / speed;
                for (int k = 1; k < D; ++k) {
                    end.bend[k - 1] = dot<D>(node.frame[k], second) / square;
                    if (end.curvature >= 0) start[part.global[end.curvature] + k - 1] = end.bend[k - 1];
                }
            }
        }
    }
    Curve(const Curve&) = delete;

    int unknowns() const { return int(start.size()); }
    int residuals() const { return int(parts.size()) * parts[0].element.residuals(); }

    // All residuals, and their Jacobian, column by column, if wanted. False outside the domain.
    bool evaluate(const double* x, double* residuals, double* jacobian, Derivatives how) const {
        const int rows = this->residuals();
        if (jacobian && parts.size() > 1) std::fill_n(jacobian, size_t(rows) * unknowns(), 0.0);
        double local[kMostLocal];
        Column columns[kMostLocal];
        int done = 0;
        for (const Part& part : parts) {
            for (int k = 0; k < part.element.unknowns; ++k) {
                local[k] = x[part.global[k]];
                if (jacobian) columns[k] = {jacobian + done + part.global[k] * rows, 1};
            }
            if (!part.element.evaluate(local, residuals + done, jacobian ? columns : nullptr, how)) return false;
            done += part.element.residuals();
        }
        return true;
    }

    // The functional: the sum of the squares.
    double value(const double* x) const {
        std::vector<double> r(residuals());
        if (!evaluate(x, r.data(), nullptr, Derivatives::by_hand)) throw std::runtime_error("outside the domain");
        double sum = 0;
        for (double c : r) sum += c * c;
        return sum;
    }

    // The rows of the elements.
    void print_rows(const double* x) const {
        for (const Part& part : parts) {
            double local[kMostLocal];
            for (int k = 0; k < part.element.unknowns; ++k) local[k] = x[part.global[k]];
            for (const auto& row : part.element.rows(local))
                for (int c = 0; c < 3; ++c) print(c < D ? row[c < D ? c : 0] : 0.0);
        }
    }

   private:
    struct Shared {
        int continuity;
        std::array<Vec<D>, D> frame;
        int tangent = -1, curvature = -1;
        Block block{0, 0};
    };

    Rule rule_;
};

}  // namespace peer
