## Grows chunks and scatters through the addon, first from a port that nothing listens at, and
## prints what came. The addresses are the arguments "dead" and "url".
extends Node3D

var _count := 0
var _grown := 0
var _failures := 0


func _ready() -> void:
	var query := StrewQuery.new()
	query.density = 0.25
	query.seed_number = 7
	query.kinds = "oak:3,birch:1"
	query.sizes = Vector2(0.7, 1.3)
	var chunks := StrewChunks3D.new()
	chunks.query = query
	chunks.meshes = [BoxMesh.new(), SphereMesh.new()]
	chunks.url = _argument("dead")
	add_child(chunks)
	chunks.grown.connect(_on_grown)
	chunks.failed.connect(_on_failed.bind(chunks))
	chunks.around(Vector3(1000, 0, 500))
	await get_tree().create_timer(0.1).timeout
	while _grown < 25:
		await get_tree().process_frame
	print("%d points in %d chunks after %d failures" % [_count, _grown, _failures])
	await _scatter(StrewScatter3D.new(), query, "3D")
	await _scatter(StrewScatter2D.new(), query, "2D")
	await _refused()
	get_tree().quit()


func _argument(name: String) -> String:
	var found := ""
	for argument in OS.get_cmdline_user_args():
		if argument.begins_with(name + "="):
			found = argument.trim_prefix(name + "=")
	return found


func _on_grown(_column: int, _row: int, points: int) -> void:
	_count += points
	_grown += 1


func _on_failed(_message: String, chunks: StrewChunks3D) -> void:
	_failures += 1
	chunks.find_children("*", "StrewSource", true, false)[0].url = _argument("url")


# Shows a scatter and bakes it: as many nodes as points.
func _scatter(scatter: Node, query: StrewQuery, words: String) -> void:
	scatter.query = query
	scatter.url = _argument("url")
	scatter.region = Rect2(100, 200, 30, 20)
	scatter.meshes = [BoxMesh.new()] as Array[Mesh]
	add_child(scatter)
	var shown: int = await scatter.scattered
	var baked: Node = scatter.bake()
	var place: Variant = baked.get_child(0).position
	print("%s: %d shown, %d baked" % [words, shown, baked.get_child_count()])
	print("%s: inside %s" % [words, _is_inside(place)])


# Places are relative to the lower corner of the box.
func _is_inside(place: Variant) -> bool:
	var up: float = -place.z if place is Vector3 else -place.y
	return place.x >= 0 and place.x < 30 and up >= 0 and up < 20


func _refused() -> void:
	var scatter := StrewScatter3D.new()
	scatter.query = StrewQuery.new()
	scatter.query.density = -1.0
	scatter.url = _argument("url")
	add_child(scatter)
	var message: String = await scatter.failed
	print("refused: ", message.contains("density"))
