/* Prints the corpus, a line a part of a case: name, hash, how it ended. */
#include "corpus/corpus.h"
#include "platform/platform.h"

static void print(const char *name, uint64_t hash, const char *outcome) {
    static const char hex[] = "0123456789abcdef";
    char text[19] = " ";
    for (int i = 0; i < 16; i++) {
        text[1 + i] = hex[hash >> (60 - 4 * i) & 15];
    }
    text[17] = ' ';
    platform_print(name);
    platform_print(text);
    platform_print(outcome);
    platform_print("\n");
}

#ifndef WITH_LONG
#define WITH_LONG 0
#endif

int main(void) {
    corpus(print, WITH_LONG);
    return 0;
}
