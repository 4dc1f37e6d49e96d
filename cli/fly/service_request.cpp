#include "cli/fly/service_request.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

#include "core/detect/feature_map_codec.hpp"
#include "core/detect/image_codec.hpp"

namespace roadfix::fly {
namespace {

using nlohmann::json;

/// A picture and the values that describe it.
struct Picture {
  json fields = json::object();
  std::string png;
};

Picture picture_of(const FeatureMap& features) {
  const auto png = encode_feature_map(features);
  return {{{"cell_m", features.cell_m},
           {"nadir_col", features.nadir.col},
           {"nadir_row", features.nadir.row},
           {"nadir_sigma_m", features.nadir_sigma_m},
           {"nadir_heading_sigma_deg", features.nadir_heading_sigma.degrees()}},
          {png.begin(), png.end()}};
}

std::string with_commas(const std::vector<double>& numbers) { return fmt::format("{}", fmt::join(numbers, ",")); }

json camera_fields(const FrameCamera& camera) {
  json fields{{"agl_m", camera.agl_m}};
  if (camera.roll) fields["roll_deg"] = camera.roll->degrees();
  if (camera.pitch) fields["pitch_deg"] = camera.pitch->degrees();
  if (camera.attitude_sigma) fields["attitude_sigma_deg"] = camera.attitude_sigma->degrees();
  if (camera.horizontal_fov) fields["fov_deg"] = camera.horizontal_fov->degrees();
  if (camera.focal_px) fields["focal_px"] = *camera.focal_px;
  if (camera.principal_px) fields["principal_px"] = with_commas({camera.principal_px->x, camera.principal_px->y});
  if (camera.lens == LensModel::kFisheye) fields["lens"] = "fisheye";
  if (!camera.distortion.empty()) fields["distortion"] = with_commas(camera.distortion);
  return fields;
}

Picture picture_of(const CameraFrame& frame, const std::optional<Altitude>& altitude) {
  const auto png = encode_frame(frame.picture);
  Picture picture{{{"kind", "frame"}, {"cell_m", frame.cell_m}}, {png.begin(), png.end()}};
  if (const auto* camera = std::get_if<FrameCamera>(&frame.view)) {
    picture.fields.update(camera_fields(*camera));
    if (altitude && altitude->above_sea_m) {
      picture.fields.erase("agl_m");
      picture.fields["alt_m"] = *altitude->above_sea_m;
    }
  } else {
    picture.fields["gsd_m"] = std::get<StraightDown>(frame.view).gsd_m;
  }
  return picture;
}

json told(const StepInput& step) {
  json fields{{"sequence", step.sequence}, {"time_us", step.time_us}};
  if (step.odometry) {
    fields["forward_m"] = step.odometry->forward_m;
    fields["right_m"] = step.odometry->right_m;
    fields["turn_deg"] = step.odometry->turn.degrees();
  }
  return fields;
}

std::string as_query(const json& fields) {
  std::string query;
  for (const auto& [name, value] : fields.items()) {
    query += (query.empty() ? "?" : "&") + name + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return query;
}

}  // namespace

json track_request(const ServicePlan& plan, std::uint64_t seed, const Prior& start) {
  const VehicleNoise& vehicle = plan.filter.vehicle;
  json request{{"map", plan.map},
               {"particles", plan.filter.particles},
               {"seed", seed},
               {"odometry_share", vehicle.odometry_share},
               {"wind_sigma_m_s", vehicle.wind.sigma_m_s},
               {"scale_range", vehicle.scale_range}};
  if (plan.filter.start_is_known) request["known_start"] = true;
  if (const auto& box = start.box) {
    request["bbox"] = {box->south_west.lon_deg, box->south_west.lat_deg, box->north_east.lon_deg,
                       box->north_east.lat_deg};
  }
  if (const auto& circle = start.circle) {
    request["lat"] = circle->centre.lat_deg;
    request["lon"] = circle->centre.lon_deg;
    request["radius_m"] = circle->radius_m;
  }
  if (const auto& heading = start.heading) {
    request["heading_deg"] = heading->centre.degrees();
    request["heading_range_deg"] = heading->half_width.degrees();
  }
  if (vehicle.planar) {
    const auto degrees = [](double radians) { return Angle::radians(radians).degrees(); };
    request["speed_m_s"] = vehicle.planar->speed_m_s.mean;
    request["speed_sigma_m_s"] = vehicle.planar->speed_m_s.sigma;
    request["turn_rate_deg_s"] = degrees(vehicle.planar->turn_rate_rad_s.mean);
    request["turn_rate_sigma_deg_s"] = degrees(vehicle.planar->turn_rate_rad_s.sigma);
  }
  return request;
}

StepRequest step_request(const Report& step) {
  json fields = told(step);
  if (!step.saw()) return {"", fields.dump(), "application/json"};
  Picture picture = step.frame ? picture_of(step.frame(), step.altitude) : picture_of(*step.features);
  fields.update(picture.fields);
  return {as_query(fields), std::move(picture.png), "image/png"};
}

}  // namespace roadfix::fly
