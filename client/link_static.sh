#!/bin/sh
# Runs the link command in its arguments with the static library in place of each shared one of gRPC, protobuf and
# Abseil that has one. Each time a program starts, the dynamic linker looks up the symbols of these sixty libraries in
# all of them. CMake's targets name the shared ones, which a module of Python needs.
set -eu
for argument; do
  shift
  case $argument in
    */libgrpc*.so* | */libgpr.so* | */libabsl_*.so* | */libupb.so* | */libaddress_sorting.so* | */libprotobuf.so*)
      static=${argument%%.so*}.a
      [ ! -e "$static" ] || argument=$static
      ;;
  esac
  set -- "$@" "$argument"
done
exec "$@"
