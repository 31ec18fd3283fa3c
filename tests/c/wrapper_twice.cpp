// The wrapper in a second translation unit of the same program.
#include "minvar.hpp"
#include "minvar.hpp"

double length_in_another_unit(const minvar::Curve &curve) { return curve.length(); }
