## A scatter of points in a box of the plane, as meshes: shown in the editor and in the game.
##
## The box is in meters of the node: x to the right, y to the north, which is −z. [method bake]
## turns what is shown into nodes of the scene, which need neither daemon nor library any more.
@tool
class_name StrewScatter3D
extends Node3D

## The points are there.
signal scattered(count: int)
## The points are not there; a daemon that does not answer is asked again.
signal failed(message: String)

const BAKED := "Baked"

## The points.
@export var query: StrewQuery:
	set(value):
		if query != null:
			query.changed.disconnect(_later)
		query = value
		if query != null:
			query.changed.connect(_later)
		_later()
## The box that is scattered, in meters.
@export var region := Rect2(-16, -16, 32, 32):
	set(value):
		region = value
		_later()
## A mesh for each kind, in the order of their names.
@export var meshes: Array[Mesh] = []:
	set(value):
		meshes = value
		_later()
## A scene for each kind, which baking puts in the place of its mesh.
@export var scenes: Array[PackedScene] = []
## The address of a daemon, for projects without the native library.
@export var url := "http://127.0.0.1:8080":
	set(value):
		url = value
		_later()

# The buffer of each kind that is shown.
var _shown := {}
var _nodes: Array[Node] = []
var _source: StrewSource
var _is_due := false


func _ready() -> void:
	_source = StrewSource.new()
	add_child(_source, false, INTERNAL_MODE_BACK)
	_source.arrived.connect(_on_arrived)
	_source.failed.connect(func(message: String, _pause: float) -> void: _tell(message))
	_source.refused.connect(func(_key: Variant, message: String) -> void: _tell(message))
	if not has_node(BAKED):
		scatter()


## Requests the points again.
func scatter() -> void:
	_is_due = false
	if _source == null or query == null:
		return
	_source.url = url
	_source.region(0, query.text(), region)


## Puts a node at each point: the scene of its kind, or else its mesh. Returns the new node whose
## children they are; null if there are no points.
func bake() -> Node3D:
	if _shown.is_empty():
		return null
	var baked := Node3D.new()
	baked.name = BAKED
	baked.position = _corner()
	for kind: int in _shown:
		var buffer: PackedFloat32Array = _shown[kind]
		for point in StrewBuffer.count(buffer):
			var node := _instance(kind)
			node.transform = StrewBuffer.transform(buffer, point)
			baked.add_child(node)
	keep(baked)
	return baked


## Adds baked nodes to the scene, in the place of what is shown and of nodes baked earlier.
func keep(baked: Node3D) -> void:
	_clear()
	if has_node(BAKED) and get_node(BAKED) != baked:
		var earlier := get_node(BAKED)
		remove_child(earlier)
		earlier.queue_free()
	if baked.get_parent() == null:
		add_child(baked)
	var scene := owner if owner != null else self
	baked.owner = scene
	for node in baked.get_children():
		node.owner = scene


func _instance(kind: int) -> Node3D:
	if kind < scenes.size() and scenes[kind] != null:
		return scenes[kind].instantiate() as Node3D
	var node := MeshInstance3D.new()
	node.mesh = _mesh(kind)
	return node


func _mesh(kind: int) -> Mesh:
	return null if meshes.is_empty() else meshes[kind % meshes.size()]


# The lower corner of the box, which places are relative to.
func _corner() -> Vector3:
	return Vector3(region.position.x, 0.0, -region.position.y)


# Several properties that change at once are one request.
func _later() -> void:
	if _source != null and not _is_due:
		_is_due = true
		scatter.call_deferred()


func _on_arrived(_key: Variant, buffer: PackedFloat32Array) -> void:
	_clear()
	_shown = StrewBuffer.by_kind(buffer)
	for kind: int in _shown:
		var node := MultiMeshInstance3D.new()
		node.multimesh = StrewBuffer.multimesh(_shown[kind], _mesh(kind))
		node.position = _corner()
		# Without an owner it is not saved with the scene.
		add_child(node, false, INTERNAL_MODE_BACK)
		_nodes.append(node)
	scattered.emit(StrewBuffer.count(buffer))


func _clear() -> void:
	for node in _nodes:
		node.queue_free()
	_nodes.clear()
	_shown.clear()


func _tell(message: String) -> void:
	push_warning(message)
	failed.emit(message)
