// Files that a command leaves behind.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace roadfix::cli {

/// Replaces the file. Throws IoFailure "result-unwritable" with the reason unless all of it was written, and leaves no
/// part of it then.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// Nothing is written over what the command reads, or over another of its outputs: throws InvalidInput
/// "target-is-source" or "target-given-twice", and "target-is-dash" for "-", which stands for no output here. Empty
/// paths are files that nobody wants.
void require_apart(std::initializer_list<std::filesystem::path> outputs,
                   std::initializer_list<std::filesystem::path> inputs);

/// Whether what goes there goes where the command prints, so that it must print elsewhere.
bool is_standard_output(const std::filesystem::path& file);

/// What takes long looks first whether its answers can be written: throws as write_file. Changes nothing; empty paths
/// are files that nobody wants.
void require_writable(std::initializer_list<std::filesystem::path> files);

}  // namespace roadfix::cli
