#include <APIHeaderSection_MakeHeader.hxx>
#include <IFSelect_ReturnStatus.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPConstruct_AP203Context.hxx>
#include <STEPControl_ActorWrite.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <StepBasic_CalendarDate.hxx>
#include <StepBasic_CoordinatedUniversalTimeOffset.hxx>
#include <StepBasic_DerivedUnitElement.hxx>
#include <StepBasic_LocalTime.hxx>
#include <StepBasic_Organization.hxx>
#include <StepBasic_Person.hxx>
#include <StepBasic_PersonAndOrganization.hxx>
#include <StepBasic_Product.hxx>
#include <StepBasic_SiUnitAndMassUnit.hxx>
#include <StepData_Protocol.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_StepWriter.hxx>
#include <StepShape_AdvancedFace.hxx>
#include <TDocStd_Document.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <XSControl_Controller.hxx>
#include <XSControl_WorkSession.hxx>
#include <cstdlib>
#include <fstream>

#include "cad/detail/ascii.h"
#include "cad/detail/exchange_file.h"
#include "cad/detail/occt_guard.h"
#include "cad/detail/part_document.h"
#include "cad/detail/real_format.h"

namespace catoptric::cad::detail {
namespace {

STEPConstruct_ContextTool& context_of(STEPControl_ActorWrite& actor);

/// Opens the actor's private context by explicit instantiation, where the language does not check access
/// (C++20 [temp.spec]/6). See provide_person for the crash that leaves no other way.
template <STEPConstruct_ContextTool STEPControl_ActorWrite::*member>
struct ContextAccess {
  friend STEPConstruct_ContextTool& context_of(STEPControl_ActorWrite& actor) { return actor.*member; }
};
template struct ContextAccess<&STEPControl_ActorWrite::myContext>;

std::string schema_name(StepSchema schema) {
  switch (schema) {
    case StepSchema::ap203:
      return "AP203";
    case StepSchema::ap214:
      return "AP214IS";
    case StepSchema::ap242:
      return "AP242DIS";
  }
  return "AP214IS";
}

int number(const std::string& stamp, std::size_t from, std::size_t length) {
  return std::atoi(stamp.substr(from, length).c_str());
}

/// Names, dates and persons inside the data section. OCCT numbers the products of one process, and AP203 puts
/// in the login name and the time of day.
void label_entities(const Handle(StepData_StepModel) & model, const FileLabels& labels) {
  const std::string& stamp = labels.time_stamp;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (const auto product = Handle(StepBasic_Product)::DownCast(entity); !product.IsNull()) {
      product->SetName(ascii(labels.product));
      product->SetId(ascii(labels.product));
    } else if (const auto person = Handle(StepBasic_Person)::DownCast(entity); !person.IsNull()) {
      person->SetId(ascii(labels.author));
      person->SetLastName(ascii(labels.author));
      person->SetFirstName(ascii(""));
      person->UnSetMiddleNames();
    } else if (const auto firm = Handle(StepBasic_Organization)::DownCast(entity); !firm.IsNull()) {
      firm->SetId(ascii(labels.organization));
      firm->SetName(ascii(labels.organization));
    } else if (const auto date = Handle(StepBasic_CalendarDate)::DownCast(entity); !date.IsNull()) {
      date->SetYearComponent(number(stamp, 0, 4));
      date->SetMonthComponent(number(stamp, 5, 2));
      date->SetDayComponent(number(stamp, 8, 2));
    } else if (const auto time = Handle(StepBasic_LocalTime)::DownCast(entity); !time.IsNull()) {
      time->SetHourComponent(number(stamp, 11, 2));
      time->SetMinuteComponent(number(stamp, 14, 2));
      time->SetSecondComponent(number(stamp, 17, 2));
    } else if (const auto zone = Handle(StepBasic_CoordinatedUniversalTimeOffset)::DownCast(entity);
               !zone.IsNull()) {
      zone->Init(0, false, 0, StepBasic_aobExact);
    }
  }
}

/// Gives AP203 its person. Left alone OCCT makes one from the login name and the machine's network address,
/// and dereferences null where that name does not resolve (a bare chroot: OSD_Host::InternetAddress,
/// OCCT 7.6.3). The same one for every file of the process, since OCCT keeps it in its approvals;
/// label_entities names it.
void provide_person(STEPControl_Writer& writer) {
  static const Handle(StepBasic_PersonAndOrganization) both = [] {
    const Handle(StepBasic_Person) person = new StepBasic_Person;
    person->Init(ascii(""), true, ascii(""), true, ascii(""), false, nullptr, false, nullptr, false, nullptr);
    const Handle(StepBasic_Organization) firm = new StepBasic_Organization;
    firm->Init(true, ascii(""), ascii(""), ascii(""));
    const Handle(StepBasic_PersonAndOrganization) pair = new StepBasic_PersonAndOrganization;
    pair->Init(person, firm);
    return pair;
  }();
  const auto actor = Handle(STEPControl_ActorWrite)::DownCast(writer.WS()->NormAdaptor()->ActorWrite());
  if (actor.IsNull())
    throw CadError({"OpenCASCADE has no STEP writer", "", "", "install libocct-data-exchange-7.6"});
  context_of(*actor).AP203Context().SetDefaultPersonAndOrganization(both);
}

void label_header(const Handle(StepData_StepModel) & model, const FileLabels& labels) {
  APIHeaderSection_MakeHeader header(model);
  header.SetName(ascii(labels.file_name));
  header.SetTimeStamp(ascii(labels.time_stamp));
  header.SetAuthorValue(1, ascii(labels.author));
  header.SetOrganizationValue(1, ascii(labels.organization));
  header.SetOriginatingSystem(ascii("catoptric"));
  header.SetAuthorisation(ascii(""));
  header.SetDescriptionValue(1, ascii("mirror of revolution"));
}

/// All settings, to be made before a writer is: one that was made earlier labels the new unit on old numbers.
void choose(ExchangeSession& session, const FileLabels& labels, LengthUnit unit, StepSchema schema) {
  session.set("xstep.cascade.unit", "MM");
  session.set("write.step.unit", unit_name(unit));
  session.set("write.step.schema", schema_name(schema));
  session.set("write.step.product.name", labels.product);
  session.set("write.surfacecurve.mode", 1);
  session.set("write.step.assembly", 0);
  session.set("write.precision.mode", 0);
}

[[noreturn]] void refuse_transfer(const std::filesystem::path& path) {
  throw CadError({"the shape does not go into STEP", path.string(), "OpenCASCADE's transfer failed",
                  "export the open surface"});
}

/// The open surface's face, which is the part itself and no piece of it to a document.
void name_faces(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i)
    if (const auto face = Handle(StepShape_AdvancedFace)::DownCast(model->Value(i)); !face.IsNull())
      face->SetName(ascii(optical_surface_name));
}

/// The powers of a density's units, g / cm^3, which OCCT 7.6.3 writes as g^3 cm^2.
void mend_density_unit(const Handle(StepData_StepModel) & model) {
  for (int i = 1; i <= model->NbEntities(); ++i)
    if (const auto element = Handle(StepBasic_DerivedUnitElement)::DownCast(model->Value(i));
        !element.IsNull())
      element->SetExponent(element->Unit()->IsKind(STANDARD_TYPE(StepBasic_SiUnitAndMassUnit)) ? 1 : -3);
}

/// Prints the model itself, since the writer's own file has 12 digits.
void print(STEPControl_Writer& writer, const Handle(StepData_StepModel) & model,
           const std::filesystem::path& path) {
  StepData_StepWriter printer(model);
  print_all_digits(printer.FloatWriter());
  printer.SendModel(Handle(StepData_Protocol)::DownCast(writer.WS()->Protocol()));
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  const bool printed = printer.Print(out);
  out.flush();
  if (!printed || !out)
    throw IoError({"cannot write the STEP file", path.string(), "", "check the free space"});
}

void finish(STEPControl_Writer& writer, const FileLabels& labels, const std::filesystem::path& path) {
  const Handle(StepData_StepModel) model = writer.Model();
  label_entities(model, labels);
  label_header(model, labels);
  print(writer, model, path);
}

}  // namespace

void write_step(const TopoDS_Shape& shape, const std::filesystem::path& path, const FileLabels& labels,
                LengthUnit unit, StepSchema schema) {
  ExchangeSession session;
  choose(session, labels, unit, schema);
  guarded("write the STEP file", path.string(), [&] {
    STEPControl_Writer writer;
    provide_person(writer);
    if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone) refuse_transfer(path);
    finish(writer, labels, path);
  });
}

void write_step_part(const TopoDS_Shape& shape, const Profile& profile, const std::filesystem::path& path,
                     const FileLabels& labels, LengthUnit unit) {
  ExchangeSession session;
  STEPCAFControl_Controller::Init();  // makes the setting of names
  choose(session, labels, unit, StepSchema::ap242);
  session.set("write.stepcaf.subshapes.name", 1);
  guarded("write the STEP file", path.string(), [&] {
    const PartDocument document;
    put_part(document, shape, profile, labels);
    STEPCAFControl_Writer writer;
    provide_person(writer.ChangeWriter());
    if (!writer.Transfer(document.get(), STEPControl_AsIs)) refuse_transfer(path);
    if (shape.ShapeType() == TopAbs_FACE) name_faces(writer.ChangeWriter().Model());
    mend_density_unit(writer.ChangeWriter().Model());
    finish(writer.ChangeWriter(), labels, path);
  });
}

std::optional<std::string> part_loss(const std::filesystem::path& path, const TopoDS_Shape& written,
                                     const Profile& profile, const FileLabels& labels) {
  ExchangeSession session;
  STEPCAFControl_Controller::Init();
  session.set("xstep.cascade.unit", "MM");
  session.set("read.stepcaf.subshapes.name", 1);
  return guarded("read the STEP file", path.string(), [&]() -> std::optional<std::string> {
    const PartDocument document;
    STEPCAFControl_Reader reader;
    reader.SetColorMode(true);
    reader.SetNameMode(true);
    reader.SetMatMode(true);
    Handle(TDocStd_Document) inside = document.get();
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || !reader.Transfer(inside))
      return "names and colours cannot be read back";
    return difference(document, written, profile, labels);
  });
}

TopoDS_Shape read_step(const std::filesystem::path& path) {
  ExchangeSession session;
  session.set("xstep.cascade.unit", "MM");
  return guarded("read the STEP file", path.string(), [&] {
    STEPControl_Reader reader;
    // Any other status, and no roots at all, must not reach TransferRoots: it crashes there.
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone || reader.NbRootsForTransfer() < 1)
      throw CadError({"this is no STEP file with geometry", path.string(), "", "check the file"});
    reader.TransferRoots();
    const TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) throw CadError({"the STEP file holds no shape", path.string(), "", "check the file"});
    return shape;
  });
}

}  // namespace catoptric::cad::detail
