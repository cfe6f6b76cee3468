## Buttons in the editor for a selected scatter: make it again, and bake it into nodes of the scene.
@tool
extends EditorPlugin

var _bar: HBoxContainer
var _scatter: Node


func _enter_tree() -> void:
	_bar = HBoxContainer.new()
	_add_button("Scatter", func() -> void: _scatter.scatter())
	_add_button("Bake", _bake)
	_bar.hide()
	add_control_to_container(CONTAINER_SPATIAL_EDITOR_MENU, _bar)


func _exit_tree() -> void:
	remove_control_from_container(CONTAINER_SPATIAL_EDITOR_MENU, _bar)
	_bar.queue_free()


func _handles(object: Object) -> bool:
	return object is StrewScatter3D or object is StrewScatter2D


func _edit(object: Object) -> void:
	_scatter = object as Node


func _make_visible(is_visible: bool) -> void:
	_bar.visible = is_visible
	# The bar follows the editor in which the node is edited.
	if is_visible and _scatter != null:
		var is_flat := _scatter is StrewScatter2D
		remove_control_from_container(CONTAINER_SPATIAL_EDITOR_MENU, _bar)
		remove_control_from_container(CONTAINER_CANVAS_EDITOR_MENU, _bar)
		add_control_to_container(
			CONTAINER_CANVAS_EDITOR_MENU if is_flat else CONTAINER_SPATIAL_EDITOR_MENU, _bar
		)


func _add_button(text: String, pressed: Callable) -> void:
	var button := Button.new()
	button.text = text
	button.pressed.connect(pressed)
	_bar.add_child(button)


func _bake() -> void:
	var baked: Node = _scatter.bake()
	if baked == null:
		return
	var undo := get_undo_redo()
	undo.create_action("Bake a scatter")
	undo.add_do_reference(baked)
	undo.add_undo_method(_scatter, "remove_child", baked)
	undo.add_do_method(_scatter, "keep", baked)
	undo.commit_action()
