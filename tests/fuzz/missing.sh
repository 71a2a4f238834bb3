#!/bin/sh
echo "skipped: libFuzzer is missing (Debian: apt-get install clang libclang-rt-dev)"
exit 77
