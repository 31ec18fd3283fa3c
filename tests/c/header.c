/* The header needs nothing before it, and may come twice. */
#include "minvar.h"
#include "minvar.h"

int main(void) { return minvar_abi_check(MINVAR_ABI) == 1 ? 0 : 1; }
