// A program that was compiled with another interface than the library has: refused before anything is called.
#include "minvar.h"
#undef MINVAR_ABI
#define MINVAR_ABI 1
#include "minvar.hpp"

#include "check.h"

int main() {
    for (int i = 0; i < 2; ++i) {
        try {
            minvar::solve({minvar::Joint::at({0, 0, 0}), minvar::Joint::at({1, 0, 0})});
            CHECK(!"thrown");
        } catch (const std::runtime_error &error) {
            CHECK(std::string(error.what()).find("another interface") != std::string::npos);
        }
        try {
            minvar::Curve curve({});
            CHECK(!"thrown");
        } catch (const std::runtime_error &) {
        }
    }
    return verdict();
}
