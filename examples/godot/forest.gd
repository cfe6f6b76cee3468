# A forest without end in Godot 3: chunks of a Strew daemon around a place, each a MultiMesh.
#
# Add this script to a Spatial, set `mesh`, and call `around` with the camera's place whenever it moved far. In Godot 4 the
# names differ (Node3D, MultiMeshInstance3D, use_custom_data), and `multimesh.buffer = body.to_float32_array()` takes the
# answer as it is.
extends Spatial

# A chunk is there: its column and row, and the number of its points.
signal grown(cx, cy, count)
# Chunks are missing. They are requested again after a pause, which doubles until an answer comes.
signal failed(message)

export var url = "http://127.0.0.1:8080"
export var query = "spacing=2&seed=7&attributes=angle,scale&scale_range=0.7,1.3"
export var side = 32.0
export var reach = 2
export var mesh: Mesh

const SHORTEST_PAUSE = 1.0
const LONGEST_PAUSE = 60.0
const WORDS = 16 # a row of 12 for the transform, and 4 of custom data

var chunks = {}
var here = Vector3()
var pause = 0.0
var is_paused = false


# Grows the chunks within `reach` of a place, and forgets those farther than twice as much.
func around(place: Vector3):
	here = place
	# The plane's y is Godot's −z.
	var cx = int(floor(place.x / side))
	var cy = int(floor(-place.z / side))
	for key in chunks.keys():
		if max(abs(key.x - cx), abs(key.y - cy)) > 2 * reach:
			chunks[key].queue_free()
			chunks.erase(key)
	if is_paused:
		return
	for y in range(cy - reach, cy + reach + 1):
		for x in range(cx - reach, cx + reach + 1):
			if not chunks.has(Vector2(x, y)):
				grow(x, y)


func grow(cx: int, cy: int):
	var chunk = MultiMeshInstance.new()
	chunk.translation = Vector3(cx * side, 0, -cy * side)
	chunks[Vector2(cx, cy)] = chunk
	add_child(chunk)
	var request = HTTPRequest.new()
	chunk.add_child(request)
	request.connect("request_completed", self, "on_answer", [cx, cy, chunk, request])
	request.request("%s/v1/chunks/%s/%d/%d?%s&format=multimesh" % [url, side, cx, cy, query])


# Requests nothing for a while, then what is missing.
func rest():
	is_paused = true
	pause = clamp(2 * pause, SHORTEST_PAUSE, LONGEST_PAUSE)
	yield(get_tree().create_timer(pause), "timeout")
	is_paused = false
	around(here)


func on_answer(result: int, status: int, _headers, body: PoolByteArray, cx: int, cy: int, chunk, request):
	request.queue_free()
	if result != HTTPRequest.RESULT_SUCCESS or status != 200:
		chunks.erase(Vector2(cx, cy))
		chunk.queue_free()
		if not is_paused:
			emit_signal("failed", body.get_string_from_utf8() if body.size() > 0 else "no answer from %s" % url)
			rest()
		return
	pause = 0.0
	var stream = StreamPeerBuffer.new()
	stream.data_array = body
	var buffer = PoolRealArray()
	for _i in body.size() / 4:
		buffer.append(stream.get_float())
	var multimesh = MultiMesh.new()
	multimesh.transform_format = MultiMesh.TRANSFORM_3D
	multimesh.custom_data_format = MultiMesh.CUSTOM_DATA_FLOAT
	multimesh.mesh = mesh
	multimesh.instance_count = buffer.size() / WORDS
	if multimesh.instance_count > 0:
		multimesh.set_as_bulk_array(buffer)
	chunk.multimesh = multimesh
	emit_signal("grown", cx, cy, multimesh.instance_count)
