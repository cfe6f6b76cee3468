## Where points come from: the native library if it is installed, else a daemon over HTTP.
##
## Each request has a key and arrives as the buffer of a [MultiMesh]: 16 floats for each point, the
## three rows of a transform, the index of the kind, that of the layer, and two attributes. Requests
## that fail are repeated after a pause, which doubles until an answer comes. A query that is not
## valid is refused once, with the words of the library.
@tool
class_name StrewSource
extends Node

## The points of a request.
signal arrived(key: Variant, buffer: PackedFloat32Array)
## No answer came; what is missing is requested again after `pause` seconds.
signal failed(message: String, pause: float)
## The query of a request is not valid, and is not repeated.
signal refused(key: Variant, message: String)

const NATIVE := &"StrewNative"
const SHORTEST_PAUSE := 1.0
const LONGEST_PAUSE := 60.0
const MOST_REQUESTS := 4

## The address of a daemon, for projects without the native library.
@export var url := "http://127.0.0.1:8080"
## Uses the daemon even where the native library is installed.
@export var prefers_daemon := false

# The requests that have no answer yet, by their keys.
var _waiting := {}
# The keys of those that are on their way.
var _under_way := {}
var _pause := 0.0
var _is_paused := false


## Requests a chunk: the square of the world grid with this side, column and row.
func chunk(key: Variant, query: String, side: float, column: int, row: int) -> void:
	_waiting[key] = {"query": query, "side": side, "column": column, "row": row}
	_go_on()


## Requests a box of the plane. Its places are relative to the lower corner.
func region(key: Variant, query: String, box: Rect2) -> void:
	var edges := [box.position.x, box.position.y, box.end.x, box.end.y]
	var bbox := ",".join(edges.map(func(edge: float) -> String: return str(edge)))
	_waiting[key] = {"query": "bbox=%s&%s" % [bbox, query]}
	_go_on()


## Forgets a request.
func cancel(key: Variant) -> void:
	_waiting.erase(key)


func _go_on() -> void:
	if _is_paused or not is_inside_tree():
		return
	for key: Variant in _waiting.keys():
		if _under_way.size() >= MOST_REQUESTS:
			return
		if not _under_way.has(key):
			_under_way[key] = true
			_send(key, _waiting[key])


func _enter_tree() -> void:
	_go_on.call_deferred()


func _send(key: Variant, wanted: Dictionary) -> void:
	if ClassDB.class_exists(NATIVE) and not prefers_daemon:
		WorkerThreadPool.add_task(_make.bind(key, wanted))
		return
	var path := "/v1/points?"
	if wanted.has("side"):
		path = "/v1/chunks/%s/%d/%d?" % [wanted.side, wanted.column, wanted.row]
	var request := HTTPRequest.new()
	add_child(request)
	request.request_completed.connect(_on_answer.bind(key, wanted, request))
	var error := request.request("%s%s%s&format=multimesh" % [url, path, wanted.query])
	if error != OK:
		request.queue_free()
		_fail(key, "%s cannot be requested: %s" % [url, error_string(error)])


# In a thread of the pool.
func _make(key: Variant, wanted: Dictionary) -> void:
	var native: RefCounted = ClassDB.instantiate(NATIVE)
	var buffer: PackedFloat32Array
	if wanted.has("side"):
		buffer = native.call(&"chunk", wanted.query, wanted.side, wanted.column, wanted.row)
	else:
		buffer = native.call(&"region", wanted.query)
	_on_made.call_deferred(buffer, native.call(&"message"), key, wanted)


func _on_made(
	buffer: PackedFloat32Array, message: String, key: Variant, wanted: Dictionary
) -> void:
	_under_way.erase(key)
	if message == "":
		_deliver(key, wanted, buffer)
	else:
		_refuse(key, wanted, message)
	_go_on()


func _on_answer(
	result: int,
	status: int,
	_headers: PackedStringArray,
	body: PackedByteArray,
	key: Variant,
	wanted: Dictionary,
	request: HTTPRequest
) -> void:
	request.queue_free()
	if result != HTTPRequest.RESULT_SUCCESS or status == 429 or status >= 500:
		_fail(key, "no answer from %s" % url if body.is_empty() else body.get_string_from_utf8())
		return
	_under_way.erase(key)
	_pause = 0.0
	if status == 200:
		_deliver(key, wanted, body.to_float32_array())
	else:
		_refuse(key, wanted, body.get_string_from_utf8())
	_go_on()


# An answer to a request that was made anew or forgotten meanwhile is dropped.
func _deliver(key: Variant, wanted: Dictionary, buffer: PackedFloat32Array) -> void:
	if is_same(_waiting.get(key), wanted):
		_waiting.erase(key)
		arrived.emit(key, buffer)


func _refuse(key: Variant, wanted: Dictionary, message: String) -> void:
	if is_same(_waiting.get(key), wanted):
		_waiting.erase(key)
		refused.emit(key, message)


func _fail(key: Variant, message: String) -> void:
	_under_way.erase(key)
	if _is_paused:
		return
	_is_paused = true
	_pause = clampf(2.0 * _pause, SHORTEST_PAUSE, LONGEST_PAUSE)
	failed.emit(message, _pause)
	if is_inside_tree():
		await get_tree().create_timer(_pause).timeout
	_is_paused = false
	_go_on()
