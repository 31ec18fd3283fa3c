# make coving        the main job: the coving of the thesis from data to NC path and picture, in coving/
# make test          everything that is promised, checked (Rust, a C and C++ compiler, Ceres)
# make test-clients  the same with heavy real clients (LinuxCNC's interpreter)
# make no-panic      proves at link time that no function of the C library can panic (no-panic-arm: on a Cortex-M)
# make miri          the tests of the C boundary under Miri, which sees every wrong access (some minutes; nightly Rust)
# make fuzz          hostile input, FUZZ_SECONDS (60) each: the C boundary, the reader, paths, against Ceres (FUZZ=path: one)
# make sanitize      the C examples and tests under AddressSanitizer and UndefinedBehaviorSanitizer, and valgrind
# make lint          formatting, clippy, documentation
# make header        writes include/minvar.h anew
# make table         Appendix A of the thesis: published, ours, Ceres; iterations from the data alone
# make random        20,000 random problems, judged independently; libspiro and OpenCASCADE beside
# make bench         minvar against Ceres, libspiro and OpenCASCADE, as ratios in one run (some minutes)
# make profile       instructions an element of every set of Appendix A, and where they go
# make memory        bytes of workspace, stack and code
# make cross         the same bits on ten targets: x86 of four kinds, AArch64, RISC-V, Cortex-M4, M7, M33, WebAssembly
# make cross-ci      the same on six of them, in minutes; and that a platform's sine or a fused multiply-add is noticed
# make bounds        stack, instructions and code on x86-64, Cortex-M7 and M4: writes docs/bounds.md anew (some minutes)
# make cross-hashes  writes tests/cross/hashes.txt anew
# make pictures      draws docs/*.svg anew
# make figures       draws the figures of thesis chapter 4 into docs/figures, with Table 4.1 and the iterations
# make mutants       small changes of the kernel: which of them the tests notice (hours; MUTANTS="--sample 500" for some)
# make help          this text
#
# Every target installs what it needs from Debian's packages, if it may.

CARGO ?= cargo
CC ?= cc
CXX ?= c++
CFLAGS ?= -O2
OUT := coving
LIB := target/release/libminvar.a
WARN := -std=c11 -Wall -Wextra -Wpedantic -Wconversion -Werror

.PHONY: coving test test-clients no-panic no-panic-arm miri fuzz sanitize lint header help tools ceres lib examples table random \
	bench profile peer-tools memory pictures figures clean cross cross-ci cross-hashes cross-curves cross-tools bounds mutants

help:
	@sed -n '/^#$$/q; s/^# //p' Makefile

tools:
	@command -v $(CARGO) >/dev/null || { echo "minvar needs Rust 1.89 or later: https://rustup.rs" >&2; exit 1; }
	@scripts/need.sh $(CC) gcc "the C compiler"

# What the package minvar-tests is built with.
ceres: tools
	@scripts/need.sh $(CXX) g++ "the C++ compiler"
	@scripts/need.sh /usr/include/ceres/ceres.h libceres-dev "the reference that curves are checked against"

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
	@echo "The published curve cuts off the corner of a square duct. With the duct's faces as obstacles it is clear:"
	target/release/minvar curve tests/data/curves/coving_clear.mvc --elements-per-span 8 \
		--svg $(OUT)/clear_of_the_duct.svg --polygon "0,0 6,0 6,-6 0,-6"
	@echo
	@ls -l $(OUT)

test: ceres
	MINVAR_HEADER=check $(CARGO) build --locked --release -p minvar-ffi
	$(CARGO) test --locked --workspace --exclude minvar-ffi

test-clients: coving
	@scripts/need.sh rs274 linuxcnc-uspace "a real control's interpreter"
	scripts/rs274.sh $(OUT)/coving.ngc $(OUT)/clear_of_the_duct.ngc

# Twice, by either model of what references may do. Reading a workspace that nobody has written is an error here too.
# libm's inline assembly, which Miri does not run, is left out; square roots are the processor's instruction as ever.
MIRI ?= cargo +nightly miri
MIRI_STRICT := -Zmiri-strict-provenance -Zmiri-symbolic-alignment-check

miri: tools
	@$(MIRI) --version >/dev/null 2>&1 || { \
		echo "Miri is missing: rustup toolchain install nightly --component miri --component rust-src" >&2; exit 1; }
	MIRIFLAGS="$(MIRI_STRICT)" $(MIRI) test --locked -p minvar-ffi-tests --features no-assembly
	MIRIFLAGS="$(MIRI_STRICT) -Zmiri-tree-borrows" $(MIRI) test --locked -p minvar-ffi-tests --features no-assembly

# As often as wanted: `make fuzz FUZZ=reference FUZZ_SECONDS=1800`. Exit status 1 if something is found.
FUZZ ?= c_curve c_chain constraints path reference
fuzz: ceres
	@scripts/fuzz.sh build
	@$(MAKE) --no-print-directory -k -j$$(nproc) $(FUZZ:%=fuzz-run-%)

fuzz-run-%:
	@scripts/fuzz.sh run $*

sanitize: tools
	scripts/sanitize.sh

# Published / ours / Ceres for every set of Appendix A.
table: ceres
	$(CARGO) run --locked --release -p minvar-tests --bin table

# Peers get the flags that are best for them; processor features beyond the baseline nobody gets.
PEERS := target/peers
PEER_FLAGS := -std=c++17 -Wall -Wextra -O3 -DNDEBUG -fno-math-errno

peer-tools: ceres
	@scripts/need.sh /usr/include/spiroentrypoints.h libspiro-dev "a peer that takes points"
	@scripts/need.sh /usr/include/opencascade/FairCurve_MinimalVariation.hxx libocct-modeling-algorithms-dev \
		"a peer that takes two points and tangents"
	@scripts/need.sh /usr/include/opencascade/Geom2d_BSplineCurve.hxx libocct-modeling-data-dev "what that peer makes"
	@mkdir -p $(PEERS)

$(PEERS)/least_squares: tests/peers/least_squares.cpp $(wildcard tests/peers/*.hpp) | peer-tools
	$(CXX) $(PEER_FLAGS) -isystem /usr/include/eigen3 $< -lceres -lglog -o $@

$(PEERS)/spiro $(PEERS)/random_spiro: $(PEERS)/%: tests/peers/%.cpp tests/peers/peer.hpp | peer-tools
	$(CXX) $(PEER_FLAGS) $< -lspiro -o $@

OCCT := -lTKGeomAlgo -lTKG2d -lTKMath -lTKernel
$(PEERS)/opencascade: tests/peers/opencascade.cpp tests/peers/peer.hpp | peer-tools
	$(CXX) $(PEER_FLAGS) -isystem /usr/include/opencascade $< $(OCCT) -o $@

$(PEERS)/random_occt: tests/peers/random_occt.cpp | peer-tools
	$(CXX) $(PEER_FLAGS) -isystem /usr/include/opencascade $< $(OCCT) -o $@

bench: $(PEERS)/least_squares $(PEERS)/spiro $(PEERS)/opencascade
	$(CARGO) run --locked --release -p minvar-tests --bin bench -- $(PEERS) target/bench.jsonl

# Exit status 1 if a promise is broken. RANDOM="--seed 2 --list" for others.
random: $(PEERS)/random_spiro $(PEERS)/random_occt
	$(CARGO) run --locked --release -p minvar-tests --bin random -- \
		--spiro $(PEERS)/random_spiro --occt $(PEERS)/random_occt $(RANDOM)

# Counted by valgrind's callgrind: no other program on the machine changes a figure.
profile: ceres
	@scripts/need.sh valgrind valgrind "what counts instructions"
	$(CARGO) build --locked --release -p minvar-tests --bin profile
	@for decrease in 1e-6 1e-12; do \
		printf '\nTo %s: thousand instructions an element, and how many of a hundred go where.\n' $$decrease; \
		echo '| set | elements | iterations | linearisations an element | thousand | start | arc length | fit | Hessians | unknowns | values | algebra | figures | rest |'; \
		echo '| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |'; \
		scripts/profile.sh target/release/profile $$decrease || exit 1; \
	done

memory: examples
	$(CC) -std=gnu11 -Wall -Wextra -O2 -Iinclude tests/c/memory.c $(LIB) -lm -lpthread -o target/c_examples/memory
	target/c_examples/memory
	$(CC) -Os -ffunction-sections -Iinclude c_examples/01_coving.c $(LIB) -lm -Wl,--gc-sections -o target/c_examples/small
	@printf 'int main(void) { return 0; }\n' | $(CC) -Os -x c - -o target/c_examples/empty
	@echo
	size target/c_examples/small target/c_examples/empty

# Every target on its own, as many at once as there are processors and one more: some wait for others or for the network.
CROSS_CI := cortex-m4 aarch64 x86-64 wasm x86-64-native x86-64-debug
CROSS_ALL := cortex-m4 cortex-m33 cortex-m7 aarch64 riscv64 x86-64 i686 wasm x86-64-native x86-64-debug
CROSS_JOBS := $(shell expr $$(nproc) + 1)

cross-tools: tools
	@scripts/need.sh clang clang "the compiler of C for other machines"
	@scripts/need.sh ld.lld lld "its linker"
	@scripts/need.sh node nodejs "what runs WebAssembly"

cross: cross-tools
	@$(MAKE) --no-print-directory -k -j$(CROSS_JOBS) $(CROSS_ALL:%=cross-run-%) CROSS_FLAGS=-DWITH_LONG=1 || true
	@scripts/cross/table.sh $(CROSS_ALL)

cross-ci: cross-tools ceres
	@$(MAKE) --no-print-directory -k -j$(CROSS_JOBS) $(CROSS_CI:%=cross-run-%) || true
	@scripts/cross/table.sh --short $(CROSS_CI)
	@scripts/cross/published.sh
	@scripts/cross/planted.sh

cross-run-%:
	@scripts/cross/run.sh $* corpus $(CROSS_FLAGS)

# What this machine computes becomes what every machine must: `make cross` says whether it does.
cross-hashes: tools
	@scripts/cross/run.sh x86-64 corpus -DWITH_LONG=1
	cp target/cross/x86-64/corpus.txt tests/cross/hashes.txt

cross-curves: ceres
	$(CARGO) run --locked --release -p minvar-tests --bin cross_curves >target/curves.inc
	mv target/curves.inc tests/cross/corpus/curves.inc

# Stack, instructions, code: docs/bounds.md.
bounds: cross-tools ceres
	@scripts/need.sh valgrind valgrind "what counts instructions"
	scripts/cross/bounds.sh >target/bounds.md
	mv target/bounds.md docs/bounds.md

pictures: tools
	$(CARGO) build --locked --release -p minvar-cli
	@mkdir -p docs
	target/release/minvar curve tests/data/curves/coving_clear.mvc --elements-per-span 8 --svg docs/coving.svg \
		--polygon "0,0 6,0 6,-6 0,-6"
	target/release/minvar curve tests/data/curves/woodford.mvc --svg docs/woodford.svg
	target/release/minvar curve tests/data/curves/peters_helix.mvc --svg docs/peters_helix.svg

# Chapter 4 of the thesis, from Appendix A: one picture a figure and a page that shows them.
figures: ceres
	$(CARGO) run --locked --release -p minvar-tests --bin figures

# All changes are woven into one copy of the kernel in target/mutants. Stopped and started again, it goes on.
mutants: ceres
	@command -v cargo-mutants >/dev/null || test -x target/mutants/tools/bin/cargo-mutants || \
		$(CARGO) install --locked --version 27.1.0 --root target/mutants/tools cargo-mutants
	PATH="$$PATH:$(CURDIR)/target/mutants/tools/bin" CARGO_TARGET_DIR=$(CURDIR)/target/mutants/tool \
		nice $(CARGO) run --locked --release --manifest-path mutants/Cargo.toml -- $(MUTANTS)

lint: ceres
	$(CARGO) fmt --all --check
	$(CARGO) fmt --check --manifest-path fuzz/Cargo.toml
	@$(CARGO) metadata --locked --format-version 1 --manifest-path fuzz/Cargo.toml >/dev/null || { \
		echo "fuzz/Cargo.lock is behind Cargo.lock: cargo fetch --manifest-path fuzz/Cargo.toml" >&2; exit 1; }
	$(CARGO) clippy --locked --workspace --exclude minvar-ffi --all-targets -- -D warnings
	$(CARGO) clippy --locked -p minvar-ffi -- -D warnings
	RUSTDOCFLAGS="-D warnings" $(CARGO) doc --locked --workspace --exclude minvar-ffi --no-deps

no-panic: tools
	@scripts/need.sh $(CC) gcc "the linker"
	scripts/no_panic.sh

# The same on a Cortex-M.
no-panic-arm: cross-tools
	scripts/no_panic.sh thumbv7em-none-eabihf

header: tools
	touch ffi/build.rs
	$(CARGO) build --locked --release -p minvar-ffi

clean:
	$(CARGO) clean
	rm -rf $(OUT)
