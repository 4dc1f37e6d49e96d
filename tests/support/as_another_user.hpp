// What a program without rights meets, also where the tests run as root.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

namespace roadfix::testing {

/// The rights of root, who may read everything, are laid down for as long as this lives.
class AsAnotherUser {
 public:
  AsAnotherUser() { is_root_ = geteuid() == 0 && seteuid(65534) == 0; }
  ~AsAnotherUser() { EXPECT_TRUE(!is_root_ || seteuid(0) == 0); }
  AsAnotherUser(const AsAnotherUser&) = delete;
  AsAnotherUser& operator=(const AsAnotherUser&) = delete;
  bool may_do_everything() const { return geteuid() == 0; }  // where there is no other user

 private:
  bool is_root_ = false;
};

}  // namespace roadfix::testing
