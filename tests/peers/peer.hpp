// What the peers share: a case as text, and a clock. A peer is a program that reads commands line by line, answers each with
// one line, and so takes its turn in the rounds of the benchmark.
#pragma once

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace peer {

using Vector = std::array<double, 3>;

struct Quantity {
    bool fixed;
    Vector value;
};

struct Joint {
    int continuity;  // 0, 1, 2: what the two elements share
    Vector point;
    Quantity tangent, curvature;
};

struct Node {
    double t, weight;
};

// C(0), C'(0), C''(0), C''(1), C'(1), C(1).
using Rows = std::array<Vector, 6>;

struct Case {
    bool bending;  // MEC; otherwise MVC
    int dimension;
    bool closed;
    std::vector<Joint> joints;
    std::vector<Node> rule;
    std::vector<Rows> start;  // one an element

    size_t spans() const { return closed ? joints.size() : joints.size() - 1; }
};

// Streams refuse numbers that underflow; strtod takes them as they are.
inline void read(std::istream& in, double& x) {
    std::string word;
    in >> word;
    char* end = nullptr;
    x = std::strtod(word.c_str(), &end);
    if (word.empty() || *end) in.setstate(std::ios::failbit);
}
inline void read(std::istream& in, Vector& v) {
    for (double& x : v) read(in, x);
}

// case mvc|mec DIMENSION open|closed JOINTS POINTS ELEMENTS, then for each joint: CONTINUITY, the point, whether the tangent
// is fixed and the tangent, the same of the curvature; the rule's nodes and weights; the elements' rows.
inline Case read_case(std::istream& in) {
    Case c;
    std::string functional, closure;
    size_t joints, points, elements;
    in >> functional >> c.dimension >> closure >> joints >> points >> elements;
    c.bending = functional == "mec";
    c.closed = closure == "closed";
    c.joints.resize(joints);
    for (Joint& joint : c.joints) {
        in >> joint.continuity;
        read(in, joint.point);
        for (Quantity* q : {&joint.tangent, &joint.curvature}) {
            in >> q->fixed;
            read(in, q->value);
        }
    }
    c.rule.resize(points);
    for (Node& node : c.rule) {
        read(in, node.t);
        read(in, node.weight);
    }
    c.start.resize(elements);
    for (Rows& rows : c.start)
        for (Vector& row : rows) read(in, row);
    if (!in) throw std::runtime_error("the case ends too early, or has a word where a number should be");
    return c;
}

// The mean microseconds of some work, repeated for so many seconds.
template <class Work>
double microseconds(double seconds, Work work) {
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    std::chrono::duration<double> passed{};
    size_t count = 0;
    do {
        work();
        ++count;
        passed = Clock::now() - start;
    } while (passed.count() < seconds);
    return 1e6 * passed.count() / double(count);
}

// A number to the last bit.
inline void print(double x) { std::printf("%.17g ", x); }

// Answers commands until the input ends. What `answer` throws ends the program: a peer that is wrong is of no use.
template <class Answer>
int serve(Answer answer) {
    try {
        std::string command;
        while (std::cin >> command) {
            answer(command);
            std::printf("\n");
            std::fflush(stdout);
        }
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}

}  // namespace peer
