// SPDX-License-Identifier: Apache-2.0
#include "app/cli/json_keys.h"

namespace beam {
namespace {

JsonAnswer statusKeys() {
  return {"status",
          {{"project", "its name"},
           {"folder", "its place"},
           {"read_only", "whether it can only be looked at"},
           {"capture", "folder of the capture"},
           {"preset", "draft, standard or paper"},
           {"settings.*", "what was set beside the preset"},
           {"frames[]", "names of the capture's frames"},
           {"takes[].first", "first frame that the take owns"},
           {"takes[].last", "its last frame"},
           {"takes[].step", "every how many frames"},
           {"takes[].solved_from", "the frame it is solved from: before `first` where it has a lead"},
           {"stages[].id", "as typed"},
           {"stages[].title", "as shown"},
           {"stages[].blocked", "what the stage needs and does not have"},
           {"stages[].steps[].id", "as typed"},
           {"stages[].steps[].title", "as shown"},
           {"stages[].steps[].state", "done, pending, running, failed, blocked or not needed"},
           {"stages[].steps[].key", "folder of the result below results/"},
           {"stages[].steps[].reasons[]", "why a result that was there is pending"},
           {"stages[].steps[].frames.*.state", "the same of a step that every frame has"},
           {"stages[].steps[].frames.*.key", "likewise"},
           {"stages[].steps[].frames.*.reasons[]", "likewise"},
           {"stages[].steps[].frames.*.seconds", "that the result took"},
           {"stages[].steps[].frames.*.message", "why the frame failed"},
           {"disk.in_force.results", "results of the settings in force"},
           {"disk.in_force.bytes", "what they take"},
           {"disk.other.results", "results that are not in force: of other settings, photographs or takes"},
           {"disk.other.bytes", "what they take"},
           {"disk.checkpoints_bytes", "of work that was cut off, from which a run goes on"},
           {"disk.stages[].id", "stage, as typed"},
           {"disk.stages[].title", "as shown"},
           {"disk.stages[].in_force.results", "as above"},
           {"disk.stages[].in_force.bytes", "as above"},
           {"disk.stages[].other.results", "as above"},
           {"disk.stages[].other.bytes", "as above"},
           {"left_out[].camera", "a camera that the fit goes without"},
           {"left_out[].kind", "what is wrong with it"},
           {"left_out[].frames[]", "in which frames"},
           {"left_out[].text", "in words"}}};
}

JsonAnswer stagesKeys() {
  return {"stages",
          {{"project", "its name, of a project"},
           {"preset", "in force, of a project"},
           {"stages[].id", "stage, as typed"},
           {"stages[].title", "as shown"},
           {"stages[].summary", "what it does"},
           {"stages[].steps[].id", "as typed"},
           {"stages[].steps[].title", "as shown"},
           {"stages[].steps[].source", "place in the paper"},
           {"stages[].steps[].version", "rises when equal inputs give another result"},
           {"stages[].steps[].unmasked_version", "likewise, of captures without masks"},
           {"stages[].steps[].per_frame", "whether every frame has a result"},
           {"stages[].steps[].frames", "every, first of take or in takes"},
           {"stages[].steps[].inputs[]", "steps whose results it reads"},
           {"stages[].steps[].later.inputs[]", "further ones in later frames of a take"},
           {"stages[].steps[].later.previous[]", "and those of the frame before"},
           {"stages[].settings[].key", "as typed after --set"},
           {"stages[].settings[].label", "as shown"},
           {"stages[].settings[].help", "what it does"},
           {"stages[].settings[].default", "the paper's number"},
           {"stages[].settings[].presets.*", "what each preset says"},
           {"stages[].settings[].value", "in force, of a project"},
           {"stages[].settings[].from", "default, preset NAME or set, of a project"},
           {"stages[].settings[].min", "least value"},
           {"stages[].settings[].max", "largest value"},
           {"stages[].settings[].unit", "of the value"},
           {"stages[].settings[].choices[]", "the words it takes"},
           {"stages[].settings[].advanced", "rarely needed"},
           {"stages[].settings[].speed_only", "changes no result"},
           {"stages[].settings[].pictures_only", "changes how results are drawn, and no result"}}};
}

JsonAnswer checkKeys() {
  return {"check",
          {{"path", "what was looked at"},
           {"kind", "capture, panorama or splats"},
           {"layout", "which description the capture has"},
           {"up", "its up axis"},
           {"unit.unit_m", "metres a unit"},
           {"unit.from", "what told it: convention, given, description, height or cameras"},
           {"unit.height", "of the subject, in the capture's unit"},
           {"unit.origin[]", "of the world, in the capture's axes and unit"},
           {"unit.text", "in words"},
           {"frames[]", "names"},
           {"seed_points", "their number"},
           {"cameras[].name", "as its folder"},
           {"cameras[].width", "pixels"},
           {"cameras[].height", "pixels"},
           {"cameras[].fx", "focal length, pixels"},
           {"cameras[].fy", "likewise"},
           {"cameras[].cx", "principal point, pixels"},
           {"cameras[].cy", "likewise"},
           {"cameras[].frames", "pictures that can be used"},
           {"cameras[].held_out", "kept for testing"},
           {"cameras[].mask_coverage", "share of the picture, first frame; null: no mask"},
           {"panorama.width", "pixels"},
           {"panorama.height", "pixels"},
           {"panorama.mean_radiance[]", "linear R, G, B"},
           {"panorama.brightest_direction[]", "in world axes"},
           {"splats.count", "Gaussians"},
           {"splats.sh_degree", "of their colour"},
           {"splats.has_materials", "base colour, ambient occlusion and roughness are there"},
           {"splats.low[]", "least corner of the means"},
           {"splats.high[]", "largest corner"},
           {"warnings[]", "what is wrong, a sentence each"}}};
}

JsonAnswer evaluateKeys() {
  return {"evaluate",
          {{"setting_changes[]", "where the frames are of other settings: from theirs to those in force"},
           {"results.*", "which result of a frame was scored; another where it was solved anew since"},
           {"*.*",
            "scores by what is scored and by name: psnr and psnr_mask in dB, ssim, angle_deg, "
            "mae_mm, chamfer_mm; `pictures` is their number"},
           {"over_time.frames.*.scores.*", "means of a frame, by score"},
           {"over_time.frames.*.cameras.*.*", "of each camera"},
           {"over_time.worst.*.value", "the worst of a score"},
           {"over_time.worst.*.frame", "and its frame"},
           {"over_time.worst.*.camera", "and camera, where it has one"}}};
}

JsonAnswer cleanKeys() {
  return {"clean",
          {{"dry_run", "whether nothing was removed"},
           {"freed_bytes", "or would be, of a dry run"},
           {"removed.count", "results of other settings"},
           {"removed.bytes", "what they took"},
           {"kept.count", "results in force"},
           {"kept.bytes", "what they take"},
           {"stages[].id", "stage, as typed"},
           {"stages[].title", "as shown"},
           {"stages[].removed.count", "as above"},
           {"stages[].removed.bytes", "as above"},
           {"stages[].kept.count", "as above"},
           {"stages[].kept.bytes", "as above"},
           {"stages[].blocked", "why all of its results stay"},
           {"half_built.count", "folders that killed processes left"},
           {"half_built.bytes", "what they took"},
           {"damaged.count", "results that were set aside"},
           {"damaged.bytes", "what they took"},
           {"failures", "notes of failures"},
           {"leases", "of processes that are gone"}}};
}

JsonAnswer planKeys() {
  return {"run --dry-run",
          {{"results_missing", "to compute"},
           {"results", "of the run, with those that are there"},
           {"frames_missing", "frames with something to compute"},
           {"frames", "of the run"},
           {"seconds.low", "about how long it takes, at least; `seconds` is null where nothing tells"},
           {"seconds.high", "at most"},
           {"leaves_take", "whether a frame of a take is fitted apart from it"},
           {"notes[]", "stages left out, and what they would need"},
           {"steps[].id", "as typed"},
           {"steps[].per_frame", "whether every frame has a result"},
           {"steps[].missing", "results to compute"},
           {"steps[].results", "of the run"},
           {"steps[].frames[]", "with something to compute"},
           {"steps[].seconds.low", "as above"},
           {"steps[].seconds.high", "as above"}}};
}

JsonAnswer eventKeys() {
  return {"run",
          {{"event", "stage, progress, step, step_failed, warning, waiting or, at last, finished"},
           {"stage", "of a stage that begins"},
           {"step", "which step the event is about"},
           {"frame", "and which frame"},
           {"lead", "the frame is only there for the take after it"},
           {"label", "progress: what is being done"},
           {"fraction", "progress of the step, 0 to 1"},
           {"done", "parts of the step done"},
           {"total", "of so many"},
           {"run_fraction", "progress of the run, 0 to 1"},
           {"seconds_elapsed", "of the run"},
           {"seconds_left", "of the run; null: not known yet"},
           {"key", "step: folder of the result below results/"},
           {"reused", "step: whether it was there; finished: how many were"},
           {"seconds", "that the step or the run took"},
           {"message", "of a failure or a warning"},
           {"holder", "waiting: who computes it"},
           {"outcome", "finished: done, done with failures, interrupted or failed"},
           {"exit_code", "finished: of the program"},
           {"computed", "finished: steps"},
           {"notes[]", "finished: stages left out, and what they would need"},
           {"failed[].step", "finished: which step failed"},
           {"failed[].frame", "in which frame"},
           {"failed[].lead", "as above"},
           {"failed[].message", "why"}}};
}

}  // namespace

const std::vector<JsonAnswer>& jsonAnswers() {
  static const std::vector<JsonAnswer> all = {statusKeys(), stagesKeys(), checkKeys(), evaluateKeys(),
                                              cleanKeys(),  eventKeys(),  planKeys()};
  return all;
}

}  // namespace beam
