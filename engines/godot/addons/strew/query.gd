## The query of a scatter: what its properties say, as the address of a request.
@tool
class_name StrewQuery
extends Resource

## Points per square unit.
@export_range(0.0001, 100.0, 0.0001, "or_greater") var density := 0.25:
	set(value):
		density = value
		emit_changed()
## Another seed is another scatter.
@export var seed_number := 0:
	set(value):
		seed_number = value
		emit_changed()
## Kinds with their weights, such as [code]oak:3,birch:1[/code]; none for one kind.
@export var kinds := "":
	set(value):
		kinds = value
		emit_changed()
## Spreads each kind evenly, instead of leaving it to chance.
@export var is_even := false:
	set(value):
		is_even = value
		emit_changed()
## The least and the greatest size.
@export var sizes := Vector2(1.0, 1.0):
	set(value):
		sizes = value
		emit_changed()
## Turns each instance by an angle of its own.
@export var is_turned := true:
	set(value):
		is_turned = value
		emit_changed()
## Further parameters, such as [code]keep=0.5&profile=blue[/code].
@export var further := "":
	set(value):
		further = value
		emit_changed()


## The parameters of the request.
func text() -> String:
	var attributes: Array[String] = []
	var parts: Array[String] = ["density=%s" % str(density), "seed=%d" % seed_number]
	if is_turned:
		attributes.append("angle")
	if sizes != Vector2.ONE:
		attributes.append("scale")
		parts.append("scale_range=%s,%s" % [str(sizes.x), str(sizes.y)])
	if kinds != "":
		attributes.append("variant")
		parts.append("variants=%s" % kinds.uri_encode().replace("%3A", ":").replace("%2C", ","))
		if is_even:
			parts.append("spread=even")
	if not attributes.is_empty():
		parts.append("attributes=%s" % ",".join(attributes))
	if further != "":
		parts.append(further)
	return "&".join(parts)
