// How many files and sockets the process may have open.
#pragma once

namespace roadfix::cli {

/// As many as the system lets this user have. What most systems start with, 1024 for programs that wait with select(),
/// is one for each map that is served.
void allow_all_open_files();

}  // namespace roadfix::cli
