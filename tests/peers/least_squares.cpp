// Ceres on a curve's least squares: its dense and sparse solvers and TinySolver, each with derivatives by hand and by jets, in
// two parametrisations.
//
//   case ...                  takes a case; answers the number of unknowns
//   variants                  names what can be asked for
//   value                     the sum of the squares at the start, in either parametrisation
//   check                     the largest difference of the Jacobians by hand, by jets and by differences
//   history, solve, time      see variant.hpp; with VARIANT MOST, the last with SECONDS, too
#include <cmath>
#include <memory>

#include "ceres_variants.hpp"
#include "tiny_variants.hpp"

namespace peer {
namespace {

// Everything about one case that does not depend on its dimension or its parametrisation.
struct Session {
    virtual ~Session() = default;
    virtual int unknowns() const = 0;
    virtual double value() const = 0;
    virtual double check() const = 0;
    virtual void variants(Variants& to) const = 0;
};

template <int D, bool Thesis>
struct CurveSession : Session {
    Curve<D, Thesis> curve;

    explicit CurveSession(const Case& data) : curve(data) {}
    int unknowns() const override { return curve.unknowns(); }
    double value() const override { return curve.value(curve.start.data()); }

    double check() const override {
        const int m = curve.residuals(), n = curve.unknowns();
        Eigen::MatrixXd hand(m, n), jets(m, n), differences(m, n);
        Eigen::VectorXd r(m), up(m), down(m);
        curve.evaluate(curve.start.data(), r.data(), hand.data(), Derivatives::by_hand);
        curve.evaluate(curve.start.data(), r.data(), jets.data(), Derivatives::by_jets);
        double worst = (hand - jets).cwiseAbs().maxCoeff() / hand.cwiseAbs().maxCoeff();
        std::vector<double> x = curve.start;
        for (int k = 0; k < n; ++k) {
            const double h = 1e-6;
            x[k] = curve.start[k] + h;
            curve.evaluate(x.data(), up.data(), nullptr, Derivatives::by_hand);
            x[k] = curve.start[k] - h;
            curve.evaluate(x.data(), down.data(), nullptr, Derivatives::by_hand);
            x[k] = curve.start[k];
            differences.col(k) = (up - down) / (2 * h);
        }
        // Differences are good for half the digits.
        return std::max(worst, 1e-6 * (hand - differences).cwiseAbs().maxCoeff() / hand.cwiseAbs().maxCoeff());
    }

    void variants(Variants& to) const override {
        for (const Derivatives how : {Derivatives::by_hand, Derivatives::by_jets}) {
            const std::string name = how == Derivatives::by_hand ? "/hand" : "/jets";
            const std::string suffix = name + (Thesis ? "/thesis" : "/linear");
            add_ceres(curve, how, suffix, to);
            add_tiny(curve, how, suffix, to);
        }
    }
};

template <bool Thesis>
std::unique_ptr<Session> session(const Case& data) {
    if (data.dimension == 2) return std::make_unique<CurveSession<2, Thesis>>(data);
    return std::make_unique<CurveSession<3, Thesis>>(data);
}

}  // namespace
}  // namespace peer

int main() {
    using namespace peer;
    FLAGS_minloglevel = google::GLOG_FATAL;
    std::unique_ptr<Session> linear, thesis;
    Variants variants;
    return serve([&](const std::string& command) {
        if (command == "case") {
            const Case data = read_case(std::cin);
            variants.clear();
            linear = session<false>(data);
            thesis = session<true>(data);
            linear->variants(variants);
            thesis->variants(variants);
            print(linear->unknowns());
        } else if (command == "variants") {
            for (const auto& [name, variant] : variants) std::printf("%s ", name.c_str());
        } else if (command == "value") {
            print(linear->value());
            print(thesis->value());
        } else if (command == "check") {
            print(std::max(linear->check(), thesis->check()));
        } else {
            std::string name;
            int most;
            std::cin >> name >> most;
            Variant& variant = *variants.at(name);
            if (command == "history") {
                variant.history(most);
            } else if (command == "solve") {
                variant.solve(most);
            } else if (command == "time") {
                double seconds;
                std::cin >> seconds;
                variant.time(most, seconds);
            } else {
                throw std::runtime_error("no command " + command);
            }
        }
    });
}
