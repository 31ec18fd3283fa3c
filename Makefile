# make coving        the main job: the coving of the thesis from data to NC path and picture, in coving/
# make test          everything that is promised, checked (Rust, a C and C++ compiler, Ceres)
# make test-clients  the same with heavy real clients (LinuxCNC's interpreter)
# make lint          formatting, clippy, documentation
# make header        writes include/minvar.h anew
# make table         Appendix A of the thesis: published, ours, Ceres
# make memory        bytes of workspace, stack and code
# make pictures      draws docs/*.svg anew
# make help          this text
#
# Every target installs what it needs from Debian's packages, if it may.

CARGO ?= cargo
CC ?= cc
CFLAGS ?= -O2
OUT := coving
LIB := target/release/libminvar.a
WARN := -std=c11 -Wall -Wextra -Wpedantic -Wconversion -Werror

.PHONY: coving test test-clients lint header help tools lib examples table memory pictures clean

help:
	@sed -n 's/^# \{0,1\}//p' Makefile | head -11

tools:
	@command -v $(CARGO) >/dev/null || { echo "minvar needs Rust 1.89 or later: https://rustup.rs" >&2; exit 1; }
	@scripts/need.sh $(CC) gcc "the C compiler"

lib: tools
	$(CARGO) build --locked --release -p minvar-ffi

examples: lib
	@mkdir -p target/c_examples
	$(CC) $(WARN) $(CFLAGS) -Iinclude c_examples/01_coving.c $(LIB) -lm -o target/c_examples/01_coving

coving: examples
	$(CARGO) build --locked --release -p minvar-cli
	@mkdir -p $(OUT)
	@echo
	target/c_examples/01_coving $(OUT)/clear_of_the_duct.ngc
	@echo
	target/release/minvar curve tests/data/curves/coving.mvc --elements-per-span 8 \
		--svg $(OUT)/coving.svg --polygon "0,0 6,0 6,-6 0,-6" --nc $(OUT)/coving.ngc --units inch --path-tolerance 0.001 --feed 40 --safe-height 2 \
		--csv $(OUT)/coving.csv --json $(OUT)/coving.json
	@echo
	@echo "The published curve cuts off the corner of a square duct; with the curvature that the example found it is clear:"
	target/release/minvar curve tests/data/curves/coving_clear.mvc --elements-per-span 8 \
		--svg $(OUT)/clear_of_the_duct.svg --polygon "0,0 6,0 6,-6 0,-6"
	@echo
	@ls -l $(OUT)

test: tools
	@scripts/need.sh c++ g++ "the C++ compiler"
	@scripts/need.sh /usr/include/ceres/ceres.h libceres-dev "the reference that curves are checked against"
	MINVAR_HEADER=check $(CARGO) build --locked --release -p minvar-ffi
	$(CARGO) test --locked --workspace --exclude minvar-ffi

test-clients: coving
	@scripts/need.sh rs274 linuxcnc-uspace "a real control's interpreter"
	scripts/rs274.sh $(OUT)/coving.ngc $(OUT)/clear_of_the_duct.ngc

# Published / ours / Ceres for every set of Appendix A.
table: tools
	@scripts/need.sh /usr/include/ceres/ceres.h libceres-dev "the reference that curves are checked against"
	$(CARGO) run --locked --release -p minvar-tests --bin table

memory: examples
	$(CC) -std=gnu11 -Wall -Wextra -O2 -Iinclude tests/c/memory.c $(LIB) -lm -lpthread -o target/c_examples/memory
	target/c_examples/memory
	$(CC) -Os -ffunction-sections -Iinclude c_examples/01_coving.c $(LIB) -lm -Wl,--gc-sections -o target/c_examples/small
	@printf 'int main(void) { return 0; }\n' | $(CC) -Os -x c - -o target/c_examples/empty
	@echo
	size target/c_examples/small target/c_examples/empty

pictures: tools
	$(CARGO) build --locked --release -p minvar-cli
	@mkdir -p docs
	target/release/minvar curve tests/data/curves/coving_clear.mvc --elements-per-span 8 --svg docs/coving.svg \
		--polygon "0,0 6,0 6,-6 0,-6"
	target/release/minvar curve tests/data/curves/woodford.mvc --svg docs/woodford.svg
	target/release/minvar curve tests/data/curves/peters_helix.mvc --svg docs/peters_helix.svg

lint: tools
	$(CARGO) fmt --all --check
	$(CARGO) clippy --locked --workspace --exclude minvar-ffi --all-targets -- -D warnings
	$(CARGO) clippy --locked -p minvar-ffi -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --locked --workspace --exclude minvar-ffi --no-deps

header: tools
	touch ffi/build.rs
	$(CARGO) build --locked --release -p minvar-ffi

clean:
	$(CARGO) clean
	rm -rf $(OUT)
