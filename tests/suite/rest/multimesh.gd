# Reads a buffer as Godot 3 and 4 take it and prints x, y, z, the size, the turn and the variant of each instance.
# A server has no meshes, so the rows become transforms here as they do in `MultiMesh`.
extends SceneTree


func _init():
	var file = File.new()
	if file.open(OS.get_environment("STREW_MULTIMESH"), File.READ) != OK:
		printerr("no file")
		quit(1)
		return
	var count = file.get_len() / 64
	var buffer = PoolRealArray()
	for i in 16 * count:
		buffer.append(file.get_float())
	var mesh = MultiMesh.new()
	mesh.transform_format = MultiMesh.TRANSFORM_3D
	mesh.custom_data_format = MultiMesh.CUSTOM_DATA_FLOAT
	mesh.instance_count = count
	mesh.set_as_bulk_array(buffer)
	for i in count:
		var b = 16 * i
		var basis = Basis(
			Vector3(buffer[b], buffer[b + 4], buffer[b + 8]),
			Vector3(buffer[b + 1], buffer[b + 5], buffer[b + 9]),
			Vector3(buffer[b + 2], buffer[b + 6], buffer[b + 10])
		)
		var place = Vector3(buffer[b + 3], buffer[b + 7], buffer[b + 11])
		var size = basis.get_scale()
		print("instance %.6f,%.6f,%.6f,%.6f,%.6f,%d" % [
			place.x, place.y, place.z, size.y, basis.get_euler().y, int(buffer[b + 12])
		])
	quit()
