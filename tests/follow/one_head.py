"""The machine in the tests of `follow`: a head that warms in an hour and a nose that grows with it."""
HEAD = """name: head
reference_temperature: 20 degC
machine: {generator: lumped}
effects:
  - {type: node, node: head, capacity: 60 kJ/K}
  - {type: motor_loss, node: head, power: 300 W, at_speed: 2000 rpm, exponent: 1}
  - {type: link, node: head, to: ambient, conductance: 20 W/K}
start: ambient
ambient: [[0 h, 20 degC], [9 h, 20 degC]]
displacements: [{name: nose_z, sensitivities: [{node: head, sensitivity: 4 um/K}]}]
cyclograms: {day: [[60 min, 2000 rpm]]}
solver: {model: reduced}
"""
