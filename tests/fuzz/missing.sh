#!/bin/sh
echo "skipped: libFuzzer is missing (Debian: apt-get install clang libclang-rt-14-dev)"
exit 77
