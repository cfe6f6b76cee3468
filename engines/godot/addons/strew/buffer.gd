## The buffer of points that [StrewSource] returns, split by kinds.
class_name StrewBuffer

## Floats for each point: a transform in three rows, the kind, the layer, two attributes.
const STRIDE := 16
const KIND := 12
const TRANSFORM := 12


## The buffers of each kind, by its index; all of it as kind 0 if the query names no kinds.
static func by_kind(buffer: PackedFloat32Array) -> Dictionary:
	var kinds := {}
	for from in range(0, buffer.size(), STRIDE):
		var kind := maxi(int(buffer[from + KIND]), 0)
		if not kinds.has(kind):
			kinds[kind] = []
		kinds[kind].append(buffer.slice(from, from + STRIDE))
	for kind: int in kinds:
		var joined := PackedFloat32Array()
		for point: PackedFloat32Array in kinds[kind]:
			joined.append_array(point)
		kinds[kind] = joined
	return kinds


## The number of points.
static func count(buffer: PackedFloat32Array) -> int:
	@warning_ignore("integer_division")
	return buffer.size() / STRIDE


## The transform of a point, relative to the corner of its region.
static func transform(buffer: PackedFloat32Array, point: int) -> Transform3D:
	var b := buffer.slice(point * STRIDE, point * STRIDE + TRANSFORM)
	return Transform3D(
		Vector3(b[0], b[4], b[8]),
		Vector3(b[1], b[5], b[9]),
		Vector3(b[2], b[6], b[10]),
		Vector3(b[3], b[7], b[11])
	)


## The transform of a point in a plane whose y points down.
static func transform_2d(buffer: PackedFloat32Array, point: int) -> Transform2D:
	var b := buffer.slice(point * STRIDE, point * STRIDE + TRANSFORM)
	return Transform2D(Vector2(b[0], b[8]), Vector2(b[2], b[10]), Vector2(b[3], b[11]))


## A mesh at each point.
static func multimesh(buffer: PackedFloat32Array, mesh: Mesh) -> MultiMesh:
	var made := MultiMesh.new()
	made.transform_format = MultiMesh.TRANSFORM_3D
	made.use_custom_data = true
	made.mesh = mesh
	made.instance_count = count(buffer)
	if made.instance_count > 0:
		made.buffer = buffer
	return made


## A mesh at each point of a plane whose y points down.
static func multimesh_2d(buffer: PackedFloat32Array, mesh: Mesh) -> MultiMesh:
	var made := MultiMesh.new()
	made.transform_format = MultiMesh.TRANSFORM_2D
	made.mesh = mesh
	made.instance_count = count(buffer)
	for point in made.instance_count:
		made.set_instance_transform_2d(point, transform_2d(buffer, point))
	return made
