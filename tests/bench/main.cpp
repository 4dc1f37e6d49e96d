// Runs the benchmarks of one program with memory handled as the roadfix command handles it.
#include <benchmark/benchmark.h>

#include "core/units/memory.hpp"

int main(int argc, char** argv) {
  roadfix::keep_freed_memory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
