#include "digest.h"

digest empty_digest(void) { return (digest){UINT64_C(0xcbf29ce484222325)}; }

void add_byte(digest *sum, unsigned char byte) { sum->state = (sum->state ^ byte) * UINT64_C(0x100000001b3); }

void add_whole(digest *sum, uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) {
        add_byte(sum, (unsigned char)(number >> shift & 0xff));
    }
}

void add_double(digest *sum, double number) {
    const union {
        double number;
        uint64_t bits;
    } same = {number};
    const uint64_t infinity = UINT64_C(0x7ff0000000000000);
    const int is_nan = (same.bits & ~(UINT64_C(1) << 63)) > infinity;
    add_whole(sum, is_nan ? UINT64_C(0x7ff8000000000000) : same.bits);
}

void add_doubles(digest *sum, const double *numbers, size_t count) {
    for (size_t i = 0; i < count; i++) {
        add_double(sum, numbers[i]);
    }
}

void add_text(digest *sum, const char *text) {
    do {
        add_byte(sum, (unsigned char)*text);
    } while (*text++ != '\0');
}
