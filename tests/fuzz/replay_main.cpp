// Replays a corpus where libFuzzer is absent: every seed as it is, cut off at many lengths, and with single bytes
// changed. The damages are the same in every run.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <set>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::size_t kDamages = 100;

Bytes read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  in.exceptions(std::ios::badbit);
  return Bytes(std::istreambuf_iterator<char>(in), {});
}

void run(const Bytes& bytes) { LLVMFuzzerTestOneInput(bytes.data(), bytes.size()); }

void replay(const Bytes& seed) {
  run(seed);
  const std::size_t step = seed.size() / kDamages + 1;
  for (std::size_t length = 0; length < seed.size(); length += step) {
    run(Bytes(seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(length)));
  }
  std::mt19937_64 generator(seed.size());
  for (std::size_t i = 0; !seed.empty() && i < kDamages; ++i) {
    Bytes damaged = seed;
    damaged[generator() % damaged.size()] = static_cast<std::uint8_t>(generator());
    run(damaged);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s CORPUS_FOLDER\n", argv[0]);
    return 2;
  }
  try {
    std::set<std::filesystem::path> seeds;
    for (const auto& entry : std::filesystem::directory_iterator(argv[1])) seeds.insert(entry.path());
    if (seeds.empty()) {
      std::fprintf(stderr, "no seeds in %s\n", argv[1]);
      return 1;
    }
    run({});
    for (const auto& path : seeds) {
      std::printf("%s\n", path.c_str());
      std::fflush(stdout);
      replay(read_file(path));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "a decoder let this escape: %s\n", error.what());
    return 1;
  }
  return 0;
}
