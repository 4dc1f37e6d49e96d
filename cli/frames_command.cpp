#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/number_checks.hpp"
#include "cli/output_file.hpp"
#include "cli/picture_files.hpp"
#include "core/detect/frame_camera.hpp"
#include "core/units/error.hpp"
#include "core/units/text.hpp"
#include "server/api/position_answer.hpp"
#include "tiles/imagery/drone_picture.hpp"
#include "tiles/imagery/picture_tags.hpp"

namespace roadfix::cli {
namespace {

namespace fs = std::filesystem;

struct FramesOptions {
  std::vector<std::string> pictures;
  std::string csv;
  std::string sequence;
  std::optional<double> takeoff_agl_m;
  std::optional<double> takeoff_alt_m;  ///< then rows tell heights above the sea
};

std::string columns_of(const FramesOptions& options) {
  return fmt::format(
      "file,sequence,time_s,lat,lon,heading_deg,{},focal_px,roll_deg,pitch_deg,principal_px,distortion\n",
      options.takeoff_alt_m ? "alt_m" : "agl_m");
}

/// A picture whose file says all that a row needs.
struct Frame {
  std::string name;  ///< as the table has it
  std::string sequence;
  DronePicture picture;
  double height_m = 0.0;  ///< above ground, or above the sea
};

std::optional<double> height_of(const DronePicture& picture, const FramesOptions& options) {
  if (const auto& alt_m = options.takeoff_alt_m) {
    return picture.takeoff_m ? std::optional(*alt_m + *picture.takeoff_m) : std::nullopt;
  }
  if (picture.agl_m || !picture.takeoff_m) return picture.agl_m;
  return *picture.takeoff_m + options.takeoff_agl_m.value_or(0.0);
}

/// Why no row can be made of it; empty where one can.
std::string lacks(const DronePicture& picture, const std::optional<double>& height_m, const FramesOptions& options) {
  std::vector<std::string> missing;
  if (!picture.place) {
    missing.emplace_back(
        "its place (GPSLatitude and GPSLongitude in degrees, minutes and seconds, or GpsLatitude and GpsLongitude of "
        "XMP)");
  }
  if (!picture.heading) {
    missing.emplace_back(
        "where it looked (yaw, pitch and roll: GimbalYawDegree ..., CameraYawDegree ... or Camera:Yaw ...)");
  }
  if (!height_m) {
    missing.emplace_back(options.takeoff_alt_m ? "its height above the take-off (RelativeAltitude)"
                                               : "its height (RelativeAltitude or AboveGroundAltitude)");
  }
  if (!picture.focal_px && !picture.doubt) {
    missing.emplace_back(
        "its focal length (DewarpData, CalibratedFocalLength or FocalLengthIn35mmFilm, of a picture that was not cut)");
  }
  if (!missing.empty()) return fmt::format("its file does not tell {}", fmt::join(missing, ", nor "));
  if (picture.doubt) return "its file " + picture.doubt->what;
  constexpr double kHighestM = 100'000.0;
  if (std::abs(*height_m) > kHighestM) return fmt::format("its file tells a height of {:g} m", *height_m);
  if (!options.takeoff_alt_m && *height_m <= 0.0) return fmt::format("it was taken {:.1f} m above ground", *height_m);
  constexpr double kAnyAglM = 1.0;  // how high it was is no matter of where it looked
  return looks_down(camera_of(picture, {kAnyAglM, {}, {}})) ? "" : "its camera looked at the horizon or the sky";
}

bool fits_a_cell(std::string_view text) {
  return text.find_first_of(",\"\r\n") == std::string_view::npos && trimmed(text) == text;
}

/// Why the table cannot name it or its flight; empty where it can.
std::string unnameable(const std::string& name, const std::string& sequence) {
  if (!fits_a_cell(name)) {
    return fmt::format(
        "no table of frames can hold the commas, quotes, line breaks or outer blanks of '{}': rename it, or write "
        "the table into its folder",
        name);
  }
  if (!fits_a_cell(sequence)) {
    return fmt::format(
        "no table of frames can hold the commas, quotes, line breaks or outer blanks of its folder's name, '{}': "
        "name the flight with --sequence",
        sequence);
  }
  return "";
}

/// nullopt, said on stderr, where the file does not tell enough.
std::optional<Frame> frame_of(const fs::path& file, const fs::path& table_folder, const FramesOptions& options) {
  require_not_empty(file);
  DronePicture picture = drone_picture(read_picture_tags(file));
  const auto height_m = height_of(picture, options);
  const fs::path whole = fs::absolute(file).lexically_normal();
  const std::string name = whole.lexically_proximate(table_folder).generic_string();
  const std::string sequence = options.sequence.empty() ? whole.parent_path().filename().string() : options.sequence;
  std::string reason = unnameable(name, sequence);
  if (reason.empty()) reason = lacks(picture, height_m, options);
  if (!reason.empty()) {
    say_left_out(file, reason);
    return std::nullopt;
  }
  return Frame{name, sequence, std::move(picture), *height_m};
}

/// Degrees with two decimals, and without the sign of a zero.
std::string hundredths(const std::optional<Angle>& angle) {
  return angle ? fmt::format("{:.2f}", std::round(angle->degrees() * 100.0) / 100.0 + 0.0) : "";
}

std::string row_of(const Frame& frame) {
  const DronePicture& p = frame.picture;
  const std::string time = p.time_s ? fmt::format("{:.3f}", *p.time_s) : "";
  const std::string principal =
      p.principal_px ? fmt::format("{:.2f} {:.2f}", p.principal_px->x, p.principal_px->y) : "";
  return fmt::format("{},{},{},{:.8f},{:.8f},{:.2f},{:.2f},{:.2f},{},{},{},{}\n", frame.name, frame.sequence, time,
                     p.place->lat_deg, p.place->lon_deg, p.heading->compass_degrees(), frame.height_m,
                     p.focal_px.value(), hundredths(p.roll), hundredths(p.pitch), principal,
                     fmt::join(p.distortion, " "));
}

void run_frames(const FramesOptions& options) {
  const fs::path folder =
      options.csv.empty() ? fs::current_path() : fs::absolute(options.csv).lexically_normal().parent_path();
  std::vector<Frame> frames;
  const Pictures pictures = pictures_of(options.pictures, kPhotoEndings);
  const std::vector<fs::path>& files = pictures.files;
  for (const fs::path& file : files) require_apart({options.csv}, {file});
  require_writable({options.csv});
  const auto take = [&](const fs::path& file) {
    if (auto frame = frame_of(file, folder, options)) frames.push_back(std::move(*frame));
  };
  const std::size_t unread = for_each_picture(pictures, "reading", false, take);
  if (frames.empty()) {
    if (unread == files.size()) require_none(unread, files.size());
    throw InvalidInput("no-drone-pictures",
                       "none of the pictures tells where and how it was taken: programs that edit "
                       "or shrink pictures often drop that; take them as the drone stored them");
  }
  std::ranges::stable_sort(frames, {}, [](const Frame& f) { return std::pair(f.sequence, f.picture.time_s); });
  std::string table = columns_of(options);
  for (const Frame& frame : frames) table += row_of(frame);
  if (options.csv.empty()) {
    fmt::print("{}", table);
  } else {
    write_file(options.csv, table);
  }
  fmt::print(stderr, "{} of {} pictures\n", frames.size(), files.size());
  const bool above_takeoff = std::ranges::any_of(frames, [](const Frame& f) { return !f.picture.agl_m; });
  if (above_takeoff && !options.takeoff_agl_m && !options.takeoff_alt_m) {
    fmt::print(stderr,
               "heights are those above the take-off: if it lay higher or lower than the ground in the pictures, "
               "say by how much with --takeoff-agl, or for a map with terrain how high it lay with --takeoff-alt\n");
  }
  if (unread > 0) require_none(files.size() - frames.size(), files.size());
}

}  // namespace

void add_frames_command(CLI::App& app) {
  auto* command = app.add_subcommand(
      "frames", "Makes the table of frames for bench and fly out of pictures as a drone stored them (EXIF and XMP)");
  command->footer(
      "Examples: roadfix frames photos/ --csv photos/frames.csv\n"
      "          roadfix frames DJI_0042.JPG      (prints what roadfix fix --exif takes from it)\n"
      "Exit code: 0 done, 1 where a picture could not be read, 2 for wrong usage. Of several pictures the table has "
      "the others.");
  const auto options = std::make_shared<FramesOptions>();
  command->add_option("pictures", options->pictures, "JPEG files, or folders of them")->required();
  command->add_option("--csv", options->csv, "File to write, from which the pictures are named; default: print");
  command->add_option("--sequence", options->sequence, "Name of the flight; default: that of the folder")
      ->check([](const std::string& name) {
        return fits_a_cell(name) ? "" : "no table of frames can hold commas, quotes, line breaks or outer blanks";
      });
  command
      ->add_option("--takeoff-agl", options->takeoff_agl_m,
                   "How many metres the take-off lay above the ground in the pictures; default: 0")
      ->check(between(-api::kAltitude.max, api::kAltitude.max));
  command
      ->add_option("--takeoff-alt", options->takeoff_alt_m,
                   "Height of the take-off's ground above the sea in metres: the table has heights above the sea "
                   "(alt_m), for maps that know how high their ground is (roadfix terrain)")
      ->check(between(api::kAltitude.min, api::kAltitude.max))
      ->excludes("--takeoff-agl");
  command->callback([options] { run_frames(*options); });
}

}  // namespace roadfix::cli
