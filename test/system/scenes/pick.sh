# A camera, its poses, and a witness that reads the same pictures.

use_skills_of_camera() {
  local name
  for name in image_source pose_estimation; do
    cp -r "$ROSCELL_BUILD/skills/$name" "$skills"
    ask_no_cpu "$skills/$name"
  done
}

make_scenes() {
  "$ROSCELL_BUILD/bin/render_scenes" --tags 4 --frames 4 --width 320 \
    --height 240 "$scratch/scenes" > /dev/null || fail "no scenes"
}

# pick_task DECIMATION: of the poses; the witness has 2.
pick_task() {
  jq -n --arg pictures "$scratch/scenes/scene_1" --arg out "$scratch" \
    --argjson decimation "$1" '
    def ros2($topic; $type): {protocol: "ros2", endpoint: "/pick/\($topic)",
                              data_type: $type};
    def eye($id; $name; $decimation):
      {id: $id, operation: "pose_estimation", model: "apriltag3",
       parameters: {decimation: $decimation},
       input: [ros2("image"; "sensor_msgs/msg/Image"),
               ros2("camera_info"; "sensor_msgs/msg/CameraInfo")],
       output: [ros2($name; "tf2_msgs/msg/TFMessage"),
                {protocol: "file", endpoint: "\($out)/\($name)",
                 data_type: "application/json"}]};
    {task: "pick", update: {healthy_for_s: 2}, pipeline: [
      {id: "camera", operation: "image_source", model: "folder",
       parameters: {rate_hz: 10, loop: true, follow: false},
       input: {protocol: "file", endpoint: $pictures, data_type: "image/png"},
       output: [ros2("image"; "sensor_msgs/msg/Image"),
                ros2("camera_info"; "sensor_msgs/msg/CameraInfo")]},
      eye("pose"; "poses"; $decimation), eye("witness"; "seen"; 2)]}'
}

# more_lines FILE COUNT: until so many more frames have come.
more_lines() {
  local before
  before=$(wc -l < "$1")
  timeout "$deadline_s" grep -m "$2" frame_id > "$scratch/matches" \
    < <(exec tail --pid=$$ -n +"$((before + 1))" -F "$1" 2> /dev/null) \
    || fail "no more frames in $1"
}
