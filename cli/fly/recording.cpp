#include "cli/fly/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/evaluation/frame_altitude.hpp"
#include "cli/evaluation/frame_files.hpp"
#include "cli/fly/vehicle.hpp"
#include "core/detect/frame.hpp"
#include "core/units/error.hpp"
#include "core/units/file.hpp"

namespace roadfix::fly {
namespace {

using evaluation::FrameTruth;

struct Sequence {
  std::string name;
  std::vector<FrameTruth> frames;
  std::vector<double> times{};  ///< of them, in seconds
};

/// Frames of one sequence need not follow each other in the file.
std::vector<Sequence> sequences_of(std::vector<FrameTruth> frames, std::size_t max_frames) {
  std::vector<Sequence> sequences;
  for (FrameTruth& frame : frames) {
    auto found = std::ranges::find(sequences, frame.sequence, &Sequence::name);
    if (found == sequences.end()) found = sequences.insert(found, {frame.sequence, {}});
    if (max_frames == 0 || found->frames.size() < max_frames) found->frames.push_back(std::move(frame));
  }
  return sequences;
}

[[noreturn]] void refuse_time(const FrameTruth& frame, double passed, const FrameTruth& before) {
  throw InvalidInput("recording-time",
                     fmt::format("{} was taken {:.3f} s after {}, the frame before it: put the frames of a sequence in "
                                 "the order of their times, each picture once. Of several frames in a second time_s "
                                 "has to tell fractions; without time_s they are --step-s apart",
                                 frame.file.string(), passed, before.file.string()));
}

/// Seconds of each frame; the first has `step_s`. Those without a time come a step after the one before.
std::vector<double> times_of(const Sequence& sequence, double step_s) {
  struct Known {
    double told_s;
    double time_s;
  };
  std::optional<Known> known;
  std::vector<double> times;
  for (const FrameTruth& frame : sequence.frames) {
    const double before = times.empty() ? 0.0 : times.back();
    double time = before + step_s;
    if (frame.time_s && known) time = known->time_s + (*frame.time_s - known->told_s);
    if (!(time > before)) refuse_time(frame, time - before, sequence.frames[times.size() - 1]);
    if (frame.time_s) known = {*frame.time_s, time};
    times.push_back(time);
  }
  return times;
}

void require_there(const std::filesystem::path& folder, const Sequence& sequence) {
  for (const FrameTruth& frame : sequence.frames) {
    if (!std::filesystem::exists(folder / frame.file)) read_named_file(folder / frame.file);
  }
}

RecordedFrame recorded(const std::filesystem::path& folder, FrameTruth truth, double time_s, const UtmZone& zone,
                       const RecordingOptions& options) {
  const FramePixels picture = evaluation::read_frame(folder, truth, options.border);
  RecordedFrame frame;
  frame.truth = on_grid(truth.pose, zone);
  frame.time_s = time_s;
  frame.altitude = evaluation::altitude_of(
      truth, [&](double above_sea_m) { return options.agl_m(frame.truth.position, above_sea_m); });
  if (frame.altitude) std::get<FrameCamera>(truth.view).agl_m = frame.altitude->agl_m;
  frame.footprint = evaluation::footprint_of(picture, truth);
  if (options.detector != nullptr) {
    const GroundView view = evaluation::view_of(picture, truth, *options.detector);
    frame.observation.features = detect_features(*options.detector, view, options.cell_m, kDetectorSeed);
  } else {
    frame.observation.frame = [=, border = options.border, cell_m = options.cell_m] {
      return CameraFrame{evaluation::read_frame(folder, truth, border), truth.view, cell_m};
    };
  }
  return frame;
}

}  // namespace

std::vector<Recording> read_recordings(const std::filesystem::path& csv, const UtmZone& zone,
                                       const RecordingOptions& options, const OnProgress& progress) {
  std::vector<Sequence> sequences = sequences_of(evaluation::read_frames_csv(csv), options.max_frames);
  std::int64_t total = 0;
  for (Sequence& sequence : sequences) {  // before the first frame is read, since that takes long
    total += std::ssize(sequence.frames);
    sequence.times = times_of(sequence, options.step_s);
    require_there(csv.parent_path(), sequence);
  }
  std::vector<Recording> recordings;
  std::int64_t done = 0;
  for (const Sequence& sequence : sequences) {
    Recording recording{sequence.name, {}};
    for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
      recording.frames.push_back(recorded(csv.parent_path(), sequence.frames[i], sequence.times[i], zone, options));
      ++done;
      if (progress) progress(done, total);
    }
    recordings.push_back(std::move(recording));
  }
  return recordings;
}

Flight replay(const Recording& recording, const FlightPlan& plan, std::uint64_t seed,
              const std::function<void()>& seen) {
  evaluation::Random motion = motion_stream(seed);
  const OdometrySensor odometry(plan.odometry, motion);
  Flight flight;
  const RecordedFrame* before = nullptr;
  for (const RecordedFrame& frame : recording.frames) {
    const int step = static_cast<int>(flight.size());
    evaluation::Random camera = camera_stream(seed, step);
    Report input;
    input.sequence = step;
    input.time_us = std::llround(1e6 * frame.time_s);
    if (before != nullptr && plan.tells_odometry) {
      const double seconds = frame.time_s - before->time_s;
      const Odometry moved = offset_from(before->truth, odometry.drifted(frame.truth, -seconds));
      input.odometry = odometry.measure(moved, distance_m(moved), seconds, motion);
    }
    if (frame_comes(plan, step, camera)) {
      input.features = frame.observation.features;
      input.frame = frame.observation.frame;
      input.altitude = frame.altitude;
    }
    flight.push_back({frame.truth, std::move(input)});
    before = &frame;
    seen();
  }
  return flight;
}

}  // namespace roadfix::fly
