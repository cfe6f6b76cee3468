# Grows the forest around a place and says what is there: `godot3-server -s main.gd`. STREW_URL is the daemon, if it
# is another one. It gives up after the third failure.
extends SceneTree

var count = 0
var grown = 0
var failures = 0
var forest


func _init():
	forest = preload("forest.gd").new()
	if OS.has_environment("STREW_URL"):
		forest.url = OS.get_environment("STREW_URL")
	forest.connect("grown", self, "on_grown")
	forest.connect("failed", self, "on_failed")
	get_root().add_child(forest)
	# Before the first frame no node can ask.
	call_deferred("look", Vector3(1000, 0, 500))


func look(place: Vector3):
	forest.around(place)


func on_grown(_cx: int, _cy: int, points: int):
	count += points
	grown += 1
	if grown == pow(2 * forest.reach + 1, 2):
		print("%d points in %d chunks" % [count, grown])
		quit()


func on_failed(message: String):
	printerr(message)
	failures += 1
	if failures == 3:
		quit(1)
