#include "core/filter/ranges.hpp"

#include <algorithm>

#include "core/units/parallel_for.hpp"

namespace roadfix {

void for_ranges(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& work) {
  constexpr std::size_t kWorthAThread = 1024;
  const std::size_t parts =
      std::clamp<std::size_t>(count / kWorthAThread, 1, static_cast<std::size_t>(std::max(1, threads)));
  parallel_for(static_cast<int>(parts), static_cast<int>(parts), [&](int index) {
    const auto part = static_cast<std::size_t>(index);
    work(count * part / parts, count * (part + 1) / parts);
  });
}

}  // namespace roadfix
