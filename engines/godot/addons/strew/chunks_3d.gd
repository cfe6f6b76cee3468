## A world without end: the chunks around a node, loaded as it moves, and forgotten when it is far.
##
## A chunk is a square of the world grid. Neighbors fit without overlap, and each is the same in
## whatever order they are loaded. A chunk whose request failed is requested again.
class_name StrewChunks3D
extends Node3D

## A chunk is there.
signal grown(column: int, row: int, count: int)
## No answer came, or the query is not valid.
signal failed(message: String)

## The points.
@export var query: StrewQuery
## A mesh for each kind, in the order of their names.
@export var meshes: Array[Mesh] = []
## The node around which chunks are loaded; without one, call [method around].
@export var target: Node3D
## The side of a chunk, in meters.
@export var side := 32.0
## Chunks are loaded this far around the node's own.
@export var reach := 2
## The address of a daemon, for projects without the native library.
@export var url := "http://127.0.0.1:8080"

var _source: StrewSource
# The node of each chunk that is there, by its column and row.
var _chunks := {}
# Those that were requested.
var _wanted := {}
var _here := Vector2i.MAX


func _ready() -> void:
	_source = StrewSource.new()
	_source.url = url
	add_child(_source)
	_source.arrived.connect(_on_arrived)
	_source.failed.connect(func(message: String, _pause: float) -> void: failed.emit(message))
	_source.refused.connect(func(_key: Variant, message: String) -> void: failed.emit(message))


func _process(_delta: float) -> void:
	if target != null:
		around(target.global_position)


## Loads the chunks around a place of the world, and forgets those farther than twice the reach.
func around(place: Vector3) -> void:
	# The plane's y is −z.
	var here := Vector2i(floori(place.x / side), floori(-place.z / side))
	if here == _here:
		return
	_here = here
	for cell: Vector2i in _chunks.keys():
		if _is_far(cell):
			_chunks[cell].queue_free()
			_chunks.erase(cell)
	for cell: Vector2i in _wanted.keys():
		if _is_far(cell):
			_source.cancel(cell)
			_wanted.erase(cell)
	var text := query.text()
	for row in range(here.y - reach, here.y + reach + 1):
		for column in range(here.x - reach, here.x + reach + 1):
			var cell := Vector2i(column, row)
			if not _chunks.has(cell) and not _wanted.has(cell):
				_wanted[cell] = true
				_source.chunk(cell, text, side, column, row)


func _is_far(cell: Vector2i) -> bool:
	return maxi(absi(cell.x - _here.x), absi(cell.y - _here.y)) > 2 * reach


func _on_arrived(key: Variant, buffer: PackedFloat32Array) -> void:
	var cell: Vector2i = key
	_wanted.erase(cell)
	var chunk := Node3D.new()
	chunk.position = Vector3(cell.x * side, 0.0, -cell.y * side)
	var kinds := StrewBuffer.by_kind(buffer)
	for kind: int in kinds:
		var node := MultiMeshInstance3D.new()
		var mesh := null if meshes.is_empty() else meshes[kind % meshes.size()]
		node.multimesh = StrewBuffer.multimesh(kinds[kind], mesh)
		chunk.add_child(node)
	_chunks[cell] = chunk
	add_child(chunk)
	grown.emit(cell.x, cell.y, StrewBuffer.count(buffer))
