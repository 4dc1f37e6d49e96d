// The network's detector against bare OpenCV DNN on a tensor of the same size: what tiling, scaling and cells cost.
#include <benchmark/benchmark.h>

#include <opencv2/dnn.hpp>

#include "core/detect/model_files.hpp"
#include "core/detect/neural_detector.hpp"

namespace roadfix {
namespace {

/// A square picture of noise with pixels of 0.5 m.
GroundImage noise(int side) {
  GroundImage image{cv::Mat(side, side, CV_8UC3), cv::Mat(side, side, CV_8UC1, cv::Scalar(255)), 0.5};
  cv::RNG(1).fill(image.pixels, cv::RNG::UNIFORM, 0, 256);
  return image;
}

void detect(benchmark::State& state) {
  const auto model = default_model(SourceContent::kImagery);
  if (!model) {
    state.SkipWithError("no weights: set ROADFIX_MODEL");
    return;
  }
  const NeuralRoadDetector detector(*model, {static_cast<int>(state.range(1))});
  const GroundImage image = noise(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(image, 2.0, 1));
  state.counters["MP/s"] = benchmark::Counter(static_cast<double>(image.pixels.total()) / 1e6,
                                              benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(detect)
    ->Args({512, 1})
    ->Args({512, 4})
    ->Args({1024, 1})
    ->Args({2048, 1})
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void bare_network(benchmark::State& state) {
  const auto model = default_model(SourceContent::kImagery);
  if (!model) {
    state.SkipWithError("no weights: set ROADFIX_MODEL");
    return;
  }
  cv::dnn::Net net = cv::dnn::readNetFromONNX(model->string());
  const int side = static_cast<int>(state.range(0));
  cv::Mat picture(side, side, CV_32FC3);
  cv::RNG(1).fill(picture, cv::RNG::NORMAL, 0, 1);
  const cv::Mat blob = cv::dnn::blobFromImage(picture);
  for (auto _ : state) {
    net.setInput(blob);
    benchmark::DoNotOptimize(net.forward());
  }
}
BENCHMARK(bare_network)
    ->Arg(256)
    ->Arg(512)
    ->Arg(1024)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace roadfix
