// Files that a command leaves behind.
#pragma once

#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <string_view>

namespace roadfix::cli {

/// Replaces the file. Throws IoFailure "result-unwritable" with the reason unless all of it was written, and leaves the
/// file of before then. Only what no other file can take the place of, such as devices, pipes, standard output and
/// files in folders that take no new ones, may keep a part.
void write_file(const std::filesystem::path& file, std::string_view bytes);

/// Whether write_file replaces it, however often it is called: devices and pipes, and what a shell has opened for the
/// process, take each time in addition.
bool is_replaced(const std::filesystem::path& file);

/// Nothing is written over what the command reads, or over another of its outputs: throws InvalidInput
/// "target-is-source" or "target-given-twice", and "target-is-dash" for "-", which stands for no output here. Empty
/// paths are files that nobody wants.
void require_apart(std::initializer_list<std::filesystem::path> outputs,
                   std::initializer_list<std::filesystem::path> inputs);

/// Throws InvalidInput "target-is-dash" for "-", of which a file or folder would be made.
void require_name(const std::filesystem::path& output);

/// Whether what goes there goes where the command prints, so that it must print elsewhere.
bool is_standard_output(const std::filesystem::path& file);

/// Where a command prints that writes these files: standard error if one of them is standard output.
std::FILE* printed_beside(std::initializer_list<std::filesystem::path> outputs);

/// What takes long looks first whether its answers can be written: throws as write_file. Changes nothing; empty paths
/// are files that nobody wants.
void require_writable(std::initializer_list<std::filesystem::path> files);

/// The same of a folder to write into, which it makes where there is none. An empty path is one that nobody wants.
void require_folder(const std::filesystem::path& folder);

}  // namespace roadfix::cli
