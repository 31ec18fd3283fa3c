/* A hash of numbers that does not depend on the machine: FNV-1a of 64 bits over their bytes, lowest first. */
#ifndef DIGEST_H
#define DIGEST_H

#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint64_t state;
} digest;

digest empty_digest(void);
void add_byte(digest *sum, unsigned char byte);
void add_whole(digest *sum, uint64_t number);

/* A double's bits; all NaN count as one, for their sign and payload are the processor's own. */
void add_double(digest *sum, double number);
void add_doubles(digest *sum, const double *numbers, size_t count);

/* Text up to its NUL, which counts too. */
void add_text(digest *sum, const char *text);

#endif
