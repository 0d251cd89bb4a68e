# SPDX-License-Identifier: Apache-2.0
# The front door. `make demo` and `make test` install what is missing (they say so first); `make build` installs nothing.
# `make bunny` fetches the mesh of scenes/rice_bunny.
.PHONY: build demo test bunny test-long setup mutations fuzz bench bench-trace bench-textures bench-shading bench-cycles format check clean

build:
	@.ci/build release

setup:
	@.ci/setup build

demo: setup
	@.ci/demo

test: setup
	@.ci/build release
	@.ci/test release

bunny:
	@scenes/rice_bunny/fetch

test-long: setup
	@.ci/build release
	@.ci/test release -L long

mutations: setup
	@tests/mutations/run

fuzz:
	@.ci/fuzz 60

bench: build
	@bench/run

bench-trace: build
	@bench/trace

bench-textures: build
	@bench/textures

bench-shading: build
	@.ci/setup plot
	@bench/shading/run

bench-cycles: build
	@.ci/setup bench
	@bench/cycles

format:
	@git ls-files '*.c' '*.h' '*.cpp' | xargs clang-format -i

check:
	@.ci/setup build check
	@.ci/check

clean:
	rm -rf build out
