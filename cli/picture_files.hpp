// Pictures on the command line: files, and folders of them, that are worked on one by one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace roadfix::cli {

/// In small letters; files may have capitals.
inline constexpr std::initializer_list<const char*> kPhotoEndings{".jpg", ".jpeg"};
inline constexpr std::initializer_list<const char*> kPictureEndings{".jpg", ".jpeg", ".png"};

/// A single picture that cannot be used ends the command; of several it is left out.
struct Pictures {
  std::vector<std::filesystem::path> files;  ///< at least one
  bool several = false;                      ///< more than one was named, or a folder
};

/// Of folders all files with one of the endings that are not hidden, by name. Throws InvalidInput "no-pictures" of one
/// without any.
Pictures pictures_of(const std::vector<std::string>& names, std::initializer_list<const char*> endings);

/// Throws InvalidInput "image-damaged".
void require_not_empty(const std::filesystem::path& file);

/// Says on standard error why. The reason may begin with the name of the file.
void say_left_out(const std::filesystem::path& file, std::string_view reason);

/// Does `work`, called `task`, for each picture. Of several it goes on where one cannot be used, which it says, and
/// shows its progress, unless `prints` says that work prints and a person sees that. Returns how many were left out.
std::size_t for_each_picture(const Pictures& pictures, const char* task, bool prints,
                             const std::function<void(const std::filesystem::path&)>& work);

/// Throws InvalidInput "pictures-left-out": scripts learn by the exit code that results are missing.
void require_none(std::size_t left_out, std::size_t of);

}  // namespace roadfix::cli
