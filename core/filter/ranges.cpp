#include "core/filter/ranges.hpp"

#include <algorithm>
#include <thread>
#include <vector>

namespace roadfix {

void for_ranges(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work) {
  constexpr std::size_t kWorthAThread = 1024;
  const std::size_t parts =
      std::clamp<std::size_t>(count / kWorthAThread, 1, static_cast<std::size_t>(std::max(1, threads)));
  std::vector<std::jthread> helpers;
  for (std::size_t part = 1; part < parts; ++part) {
    helpers.emplace_back([&work, count, part, parts] { work(count * part / parts, count * (part + 1) / parts); });
  }
  work(0, count / parts);
}

}  // namespace roadfix
