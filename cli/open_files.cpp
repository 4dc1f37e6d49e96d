#include "cli/open_files.hpp"

#include <sys/resource.h>

namespace roadfix::cli {

void allow_all_open_files() {
  rlimit files{};
  if (getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur == files.rlim_max) return;
  files.rlim_cur = files.rlim_max;
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace roadfix::cli
